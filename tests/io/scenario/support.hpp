// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/io/scenario_io.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <string>

namespace stylet::test {

/// A folder for one test, removed afterwards.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "stylet-scenario-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) std::abort();
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code code;
    std::filesystem::remove_all(path_, code);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Writes a file and returns its path.
  std::filesystem::path write(const std::string& name, const std::string& content) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary) << content;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

/// Expects that the message contains every part.
inline void expect_says(const std::string& message, std::initializer_list<const char*> parts) {
  for (const char* part : parts)
    EXPECT_NE(message.find(part), std::string::npos) << '"' << part << "\" is not in:\n" << message;
}

/// Expects a helpful input error: one line with a place, a value and a cure.
template <class T>
std::string refusal(const Result<T>& result) {
  if (result) {
    ADD_FAILURE() << "taken";
    return {};
  }
  EXPECT_EQ(result.error().kind, ErrorKind::input);
  EXPECT_FALSE(result.error().where.empty());
  EXPECT_FALSE(result.error().what.empty());
  EXPECT_FALSE(result.error().cure.empty());
  const std::string message = result.error().message();
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  return message;
}

}  // namespace stylet::test

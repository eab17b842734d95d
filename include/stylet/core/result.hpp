// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cassert>
#include <string>
#include <utility>
#include <variant>

namespace stylet {

/// Who has to act on an error. `input`: the user has to change the input (exit status 2). `failed`: the run itself
/// failed (exit status 1).
enum class ErrorKind { input, failed };

/// An error: what is wrong, where, and what the user can do. Functions that build or load something return it; no
/// public function throws.
struct Error {
  ErrorKind kind = ErrorKind::input;
  std::string where;  ///< file and the place in it, e.g. "case.dcm, ROI 'Prostate', slice z = -35 mm"
  std::string what;   ///< the fault, with the value found, and what was expected
  std::string cure;   ///< advice to the user: one sentence in the imperative, without a full stop

  /// @return "where: what. cure" in one line
  [[nodiscard]] std::string message() const;
};

[[nodiscard]] inline Error input_error(std::string where, std::string what, std::string cure) {
  return {ErrorKind::input, std::move(where), std::move(what), std::move(cure)};
}
[[nodiscard]] inline Error failure(std::string where, std::string what, std::string cure) {
  return {ErrorKind::failed, std::move(where), std::move(what), std::move(cure)};
}

/// The value of a Result<> that carries nothing but success.
struct Ok {};

/// Either a value or an Error.
template <class T = Ok>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::move(value)) {}      // NOLINT(google-explicit-constructor)
  Result(Error error) : state_(std::move(error)) {}  // NOLINT(google-explicit-constructor)

  [[nodiscard]] bool ok() const { return std::holds_alternative<T>(state_); }
  explicit operator bool() const { return ok(); }

  [[nodiscard]] T& value() & {
    assert(ok());
    return std::get<T>(state_);
  }
  [[nodiscard]] const T& value() const& {
    assert(ok());
    return std::get<T>(state_);
  }
  [[nodiscard]] T&& value() && {
    assert(ok());
    return std::get<T>(std::move(state_));
  }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

  [[nodiscard]] const Error& error() const {
    assert(!ok());
    return std::get<Error>(state_);
  }

 private:
  std::variant<T, Error> state_;
};

}  // namespace stylet

// SPDX-License-Identifier: GPL-3.0-or-later
// Tests of randomly damaged files: whatever the parsers do, the reader must return a value or an input error within a
// time limit.
#include "files.hpp"
#include "mask_files.hpp"
#include "mesh_files.hpp"
#include "stylet/io/input.hpp"

#include <sys/resource.h>

#include <random>

using namespace stylet;
using namespace stylet::test;

namespace {

constexpr int mutations = 60;
constexpr double patience_s = 15.0;  // limit on processor time, which does not depend on the machine's load

/// Processor time of this process and of its children that have ended [s].
double processor_time_s() {
  double seconds = 0.0;
  for (const auto who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage used{};
    getrusage(who, &used);
    for (const timeval& t : {used.ru_utime, used.ru_stime})
      seconds += static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  }
  return seconds;
}

/// Applies one random change: flips bytes; overwrites, removes or duplicates a section; truncates; or replaces a number
/// in a text.
std::string mutated(std::string bytes, std::mt19937_64& random) {
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % std::max<std::size_t>(n, 1)); };
  const std::size_t at = below(bytes.size()), length = std::min(bytes.size() - at, 1 + below(40));
  switch (random() % 7) {
    case 0:
      for (int i = 0; i < 5; ++i) bytes[below(bytes.size())] ^= static_cast<char>(1 << below(8));
      break;
    case 1:
      bytes[below(std::min<std::size_t>(bytes.size(), 400))] = static_cast<char>(random());
      break;  // the header
    case 2:
      std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), length,
                  static_cast<char>(random() % 2 == 0 ? 0xff : 0));
      break;
    case 3:
      bytes.erase(at, length);
      break;
    case 4:
      bytes.insert(at, bytes.substr(at, length));
      break;
    case 5:
      bytes.resize(std::max<std::size_t>(at, 1));
      break;
    default: {  // replaces the next number in a text by an extreme one
      const auto digit = bytes.find_first_of("0123456789", at);
      const char* const extremes[] = {"-1", "0", "4294967295", "99999999999999999999", "1e308", "nan"};
      if (digit != std::string::npos) bytes.replace(digit, 1, extremes[below(6)]);
    }
  }
  return bytes;
}

void expect_sober_answers(const fs::path& path, const std::function<fs::path(const std::string&)>& put) {
  const std::string whole = content_of(path);
  std::mt19937_64 random(std::hash<std::string_view>()(path.filename().string()));
  int refused = 0;
  for (int i = 0; i < mutations; ++i) {
    const fs::path file = put(mutated(whole, random));
    const double before_s = processor_time_s();
    const auto input = read_input(file);
    EXPECT_LT(processor_time_s() - before_s, patience_s) << path.filename() << ", mutation " << i;
    if (input.ok()) continue;
    ++refused;
    EXPECT_EQ(input.error().kind, ErrorKind::input) << why(input);
    EXPECT_FALSE(input.error().what.empty());
    EXPECT_FALSE(input.error().cure.empty());
    EXPECT_EQ(why(input).find('\n'), std::string::npos) << why(input);
  }
  EXPECT_GT(refused, 0) << path.filename() << ": nothing was refused, the mutations do not bite";
}

/// Mutates a file many times, and checks the result of reading it.
void expect_sober_answers(const Folder& folder, const std::string& name, const std::string& bytes) {
  const fs::path original = write_file(folder / ("original-" + name), bytes);
  expect_sober_answers(original, [&](const std::string& changed) { return write_file(folder / name, changed); });
}

}  // namespace

TEST(MutatedFiles, structure_sets) {
  const Folder folder;
  ASSERT_TRUE(write_rtstruct(two_organs(), folder / "case.dcm").ok());
  expect_sober_answers(folder, "m.dcm", content_of(folder / "case.dcm"));
}

TEST(MutatedFiles, contour_json) {
  const Folder folder;
  ASSERT_TRUE(write_contour_json(two_organs(), folder / "case.json").ok());
  expect_sober_answers(folder, "m.json", content_of(folder / "case.json"));
}

TEST(MutatedFiles, label_masks) {
  const Folder folder;
  const Mask mask;
  expect_sober_answers(folder, "m.nii", nifti(mask));
  expect_sober_answers(folder, "m.nii.gz", gzipped(nifti(mask)));
  expect_sober_answers(folder, "raw.nrrd", nrrd(mask));
  expect_sober_answers(folder, "gzip.nrrd", nrrd(mask, "gzip"));
  expect_sober_answers(folder, "m.mha", metaimage(mask, true));
}

TEST(MutatedFiles, tetrahedral_meshes) {
  const Folder folder;
  for (const MeshFile& file : write_all_formats(two_region_box(), folder.path())) {
    if (file.path.extension() == ".node") {
      fs::copy_file(folder / "tetgen.ele", folder / "m.ele");
    } else if (file.path.extension() == ".ele") {
      fs::copy_file(folder / "tetgen.node", folder / "m.node");
    }
    const fs::path target = folder / ("m" + file.path.extension().string());
    fs::remove(target);
    expect_sober_answers(file.path, [&](const std::string& changed) { return write_file(target, changed); });
    if (file.path.extension() == ".ele") fs::remove(folder / "m.node");
    fs::remove(target);
  }
}

TEST(MutatedFiles, surfaces) {
  const Folder folder;
  expect_sober_answers(folder, "m.obj",
                       "# x\nv 0 0 0\nv 30 0 0\nv 0 30 0\nv 0 0 30\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  expect_sober_answers(
      folder, "m.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n30 0 0\n0 30 0\n3 0 1 2\n");
}

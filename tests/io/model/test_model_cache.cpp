// SPDX-License-Identifier: GPL-3.0-or-later
// Tests of the cache of compiled models: models are found by their key, and the size of the folder is limited.
#include "box.hpp"
#include "io/formats/files.hpp"

#include "model/build_id.hpp"
#include "stylet/io/model_cache.hpp"
#include "stylet/io/model_file.hpp"

#include <sys/stat.h>

#include <fstream>

namespace stylet {
namespace {

namespace fs = std::filesystem;
using test::Folder;
using test::saved_box;

std::shared_ptr<const Model> box_model() {
  return test::value_of(Model::compile(saved_box(), test::box_patient(), "box"));
}

void write(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }

std::string key(const Scenario& scenario) { return test::value_of(model_key(scenario)); }

void keep(const ModelCache& cache, const std::string& name) {
  const auto kept = cache.keep(*box_model(), name, std::vector<std::string>{"a note"});
  ASSERT_TRUE(kept) << kept.error().message();
}

std::uintmax_t size_of_one() {
  const Folder folder;
  keep(ModelCache(folder.path()), "one");
  return fs::file_size(folder.path() / "one.stylet");
}

}  // namespace

TEST(ModelCache, a_key_follows_from_everything_a_model_is_made_of) {
  const Folder folder;
  const fs::path patient = folder.path() / "patient.json";
  const fs::path motion = folder.path() / "motion.csv";
  write(patient, "{}");
  write(motion, "time_s\n");
  Scenario s = saved_box();
  s.patient.source = patient.string();
  s.insertions[0].motion = motion.string();
  const std::string first = key(s);
  EXPECT_EQ(first, key(s));

  Scenario other = s;
  other.needle.length_mm += 1.0;
  EXPECT_NE(key(other), first);
  write(patient, "{ }");
  EXPECT_NE(key(s), first);
  write(patient, "{}");
  EXPECT_EQ(key(s), first);
  write(motion, "time_s \n");
  EXPECT_NE(key(s), first);
}

TEST(ModelCache, a_key_follows_from_the_build_id_of_the_code_and_not_from_the_programs_file) {
  const std::string id = detail::build_id();
  EXPECT_EQ(id.size(), 40u);  // of SHA-1
  EXPECT_EQ(id.find_first_not_of("0123456789abcdef"), std::string::npos);
  // The program's file contains the bytes of the note that the linker wrote.
  std::ifstream file("/proc/self/exe", std::ios::binary);
  const std::string program{std::istreambuf_iterator<char>(file), {}};
  std::string bytes;
  for (std::size_t k = 0; k < id.size(); k += 2) bytes += static_cast<char>(std::stoi(id.substr(k, 2), nullptr, 16));
  EXPECT_NE(program.find(bytes), std::string::npos);
}

TEST(ModelCache, a_key_of_a_folder_knows_its_files_by_name_and_content) {
  const Folder folder;
  fs::create_directories(folder.path() / "slices" / "more");
  write(folder.path() / "slices" / "1.dcm", "one");
  write(folder.path() / "slices" / "more" / "2.dcm", "two");
  Scenario s = saved_box();
  s.patient.source = (folder.path() / "slices").string();
  const std::string first = key(s);
  write(folder.path() / "slices" / "more" / "2.dcm", "2");
  EXPECT_NE(key(s), first);
  write(folder.path() / "slices" / "more" / "2.dcm", "two");
  EXPECT_EQ(key(s), first);
  fs::rename(folder.path() / "slices" / "1.dcm", folder.path() / "slices" / "0.dcm");
  EXPECT_NE(key(s), first);
}

TEST(ModelCache, a_patient_that_is_not_there_has_no_key) {
  Scenario s = saved_box();
  s.patient.source = "/nowhere/patient.json";
  const auto made = model_key(s);
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().message().find("/nowhere/patient.json"), std::string::npos);
}

TEST(ModelCache, a_patient_in_several_files_has_no_key) {
  const Folder folder;
  const auto says_so = [&](const char* name, const std::string& header) {
    write(folder.path() / name, header);
    Scenario s = saved_box();
    s.patient.source = (folder.path() / name).string();
    const auto made = model_key(s);
    return !made && made.error().what.starts_with("its data are in several files");
  };
  EXPECT_TRUE(says_so("a.mhd", "ObjectType = Image\nElementDataFile = a.raw\n"));
  EXPECT_TRUE(says_so("b.mha", "ObjectType = Image\nElementDataFile = a.raw\n"));
  EXPECT_FALSE(says_so("c.mha", "ObjectType = Image\nElementDataFile = LOCAL\nvoxels"));
  EXPECT_TRUE(says_so("d.NHDR", "NRRD0004\n"));
  EXPECT_TRUE(says_so("e.nrrd", "NRRD0004\ntype: short\ndata file: e.raw\n"));
  EXPECT_FALSE(says_so("f.seg.nrrd", "NRRD0004\ntype: short\n\ndata file: of the voxels\n"));
  EXPECT_TRUE(says_so("g.node", "1 3 0 0\n"));
  // The content has priority over the name, and a line ends wherever any reader may see its end.
  EXPECT_TRUE(says_so("h.img", "NRRD0004\ntype: short\ndata file: e.raw\n"));
  EXPECT_TRUE(says_so("i", "ObjectType = Image\nElementDataFile = a.raw\n"));
  EXPECT_TRUE(says_so("j.nrrd", "NRRD0004\n# a comment\rdatafile: e.raw\n"));
  EXPECT_TRUE(says_so("k.mha", "ObjectType = Image\nElementDataFile : local.raw\n"));
  EXPECT_TRUE(says_so("l.mha", "ObjectType = Image\nelementdatafile = LOCAL\nElementDataFile = a.raw\n"));
  EXPECT_FALSE(says_so("m.img", "ObjectType = Image\nElementDataFile = LOCAL\nvoxels"));
}

TEST(ModelCache, finds_what_was_kept) {
  const Folder folder;
  const ModelCache cache(folder.path() / "new" / "models");
  EXPECT_FALSE(cache.find("box"));
  keep(cache, "box");
  const auto file = cache.find("box");
  ASSERT_TRUE(file);
  EXPECT_FALSE(cache.find("other"));
  const auto content = read_model_file(*file);
  ASSERT_TRUE(content) << content.error().message();
  EXPECT_EQ(content->notes, std::vector<std::string>{"a note"});
  EXPECT_EQ(content->mesh.nodes.size(), box_model()->mesh().nodes.size());
}

TEST(ModelCache, is_for_this_user_only_whatever_the_umask) {
  for (const mode_t mask : {mode_t{0}, mode_t{0777}}) {
    const Folder folder;
    const mode_t before = ::umask(mask);
    keep(ModelCache(folder.path() / "models"), "box");
    ::umask(before);
    EXPECT_EQ(fs::status(folder.path() / "models").permissions(), fs::perms(0700));
    EXPECT_EQ(fs::status(folder.path() / "models" / "box.stylet").permissions(), fs::perms(0600));
  }
}

TEST(ModelCache, looks_into_other_folders_too) {
  const Folder folder;
  keep(ModelCache(folder.path() / "given"), "box");
  EXPECT_EQ(ModelCache({}, {folder.path() / "given"}).find("box"), folder.path() / "given" / "box.stylet");
  EXPECT_FALSE(ModelCache({}, {folder.path()}).find("box"));
}

TEST(ModelCache, forgets_the_one_not_used_for_longest) {
  const Folder folder;
  const ModelCache cache(folder.path(), {}, 2 * size_of_one() + 1000);
  keep(cache, "first");
  keep(cache, "second");
  const auto long_ago = fs::file_time_type::clock::now() - std::chrono::hours(24);
  for (const char* name : {"first.stylet", "second.stylet"}) fs::last_write_time(folder.path() / name, long_ago);
  EXPECT_TRUE(cache.find("first"));  // counts as used at this moment
  write(folder.path() / "notes.txt", "not a model: stays");
  keep(cache, "third");
  EXPECT_TRUE(cache.find("first"));
  EXPECT_FALSE(cache.find("second"));
  EXPECT_TRUE(cache.find("third"));
  EXPECT_TRUE(fs::exists(folder.path() / "notes.txt"));
}

TEST(ModelCache, keeps_none_that_is_larger_than_all_may_be) {
  const Folder folder;
  const ModelCache cache(folder.path(), {}, 1000);
  keep(cache, "box");
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(ModelCache, without_a_folder_nothing_is_kept) {
  keep(ModelCache({}), "box");
  EXPECT_FALSE(ModelCache({}).find("box"));
}

TEST(ModelCache, says_which_folder_refuses) {
  const Folder folder;
  write(folder.path() / "taken", "a file");
  const auto kept = ModelCache(folder.path() / "taken").keep(*box_model(), "box");
  ASSERT_FALSE(kept);
  EXPECT_NE(kept.error().message().find((folder.path() / "taken").string()), std::string::npos);
}

}  // namespace stylet

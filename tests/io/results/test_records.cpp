// SPDX-License-Identifier: GPL-3.0-or-later
// Tests of the lists of fields: each record comes back from a file as it was written, and docs/results says what the
// lists say.
#include "h5_new_file.hpp"
#include "record/attributes.hpp"
#include "record/csv.hpp"
#include "record/implant_columns.hpp"
#include "record/json.hpp"
#include "record/rows.hpp"
#include "record/summary_columns.hpp"
#include "support/folder.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>

using namespace stylet;
using namespace stylet::results;
using stylet::test::Folder;
namespace fs = std::filesystem;

namespace {

using record::Field, record::kCsv, record::kFile, record::kJson;

/// Gives a value that no record has by itself.
class Randomly {
 public:
  explicit Randomly(unsigned seed) : random_(seed) {}

  template <class V>
  void fill(const Field& field, V& value) {
    if constexpr (std::same_as<V, std::string>) {
      value = "text " + std::to_string(random_() % 1000);
    } else if constexpr (std::same_as<V, bool>) {
      value = random_() % 2 == 0;
    } else if constexpr (std::is_enum_v<V>) {
      value = static_cast<V>(random_() % static_cast<unsigned>(record::count_of<V>()));
    } else if constexpr (std::is_floating_point_v<V>) {
      value = std::normal_distribution<V>(0, 1000)(random_);
    } else if constexpr (std::is_integral_v<V>) {
      value = static_cast<V>(random_() % 100000);
    } else if constexpr (requires { value.has_value(); }) {
      fill(field, value.emplace());
    } else if constexpr (record::HasColumns<V>) {
      record::each_field<kJson>(value, *this);
    } else {
      if constexpr (requires { value.resize(3); }) value.resize(3);
      for (auto& item : value) fill(field, item);
    }
  }
  void operator()(const Field& field, auto& value) const { const_cast<Randomly*>(this)->fill(field, value); }

 private:
  std::mt19937 random_;
};

template <record::Format in, class T>
T random_record(unsigned seed) {
  T made{};
  record::each_field<in>(made, Randomly(seed));
  return made;
}

/// The values of a record as they are in memory.
template <record::Format in, class T>
std::string memory_of(const T& record);

template <record::Format in, class V>
void append_memory(std::string& bytes, const V& value) {
  if constexpr (std::is_arithmetic_v<V> || std::is_enum_v<V>) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  } else if constexpr (std::same_as<V, std::string>) {
    bytes += value + '\0';
  } else if constexpr (requires { value.has_value(); }) {
    bytes += value ? '1' : '0';
    if (value) append_memory<in>(bytes, *value);
  } else if constexpr (record::HasColumns<V>) {
    bytes += memory_of<in>(value);
  } else {
    for (const auto& item : value) append_memory<in>(bytes, item);
  }
}

template <record::Format in, class T>
std::string memory_of(const T& record) {
  std::string bytes;
  record::each_field<in>(record, [&](const Field&, const auto& value) { append_memory<in>(bytes, value); });
  return bytes;
}

template <class T>
class RecordInRows : public ::testing::Test {};
using RowRecords = ::testing::Types<Step, Event, ContactView, ProbeMove, FrameRow, RunEnd, SeedHistory, SeedAct,
                                    RecordedScore, RecordedPlan::Needle, RecordedPlan::Seed, NeedleShape>;
TYPED_TEST_SUITE(RecordInRows, RowRecords);

template <class T>
class RecordInAttributes : public ::testing::Test {};
using AttributeRecords =
    ::testing::Types<RunInfo, RecordedPlan, NeedleHistory, RecordedStructure, RecordedDose, ImplantRecord>;
TYPED_TEST_SUITE(RecordInAttributes, AttributeRecords);

template <class T>
class RecordInJson : public ::testing::Test {};
using JsonRecords = ::testing::Types<Event, MeshChange, NeedlesInPlace, GlandMotion, Summary>;
TYPED_TEST_SUITE(RecordInJson, JsonRecords);

}  // namespace

TYPED_TEST(RecordInRows, comes_back_with_every_value) {
  const Folder folder;
  std::vector<TypeParam> wrote;
  for (unsigned seed = 0; seed < 20; ++seed) wrote.push_back(random_record<kFile, TypeParam>(seed));
  const h5::LibraryTurn turn;
  const h5::NewFile file((folder / "rows.h5").c_str());
  record::write_rows(file, "rows", record::rows_of(std::span<const TypeParam>(wrote)));
  const auto rows = record::read_rows<TypeParam>(file, "rows");
  ASSERT_EQ(rows.size(), wrote.size());
  for (std::size_t k = 0; k < wrote.size(); ++k) {
    TypeParam read{};
    ASSERT_TRUE(rows.get(k, read));
    EXPECT_EQ(memory_of<kFile>(read), memory_of<kFile>(wrote[k]));
    if (record::has_check<TypeParam>) EXPECT_TRUE(rows.is_whole(k));
  }
}

// Every bit of a row but those of its check counts.
TYPED_TEST(RecordInRows, with_any_byte_changed_has_a_wrong_check) {
  if (!record::has_check<TypeParam>) GTEST_SKIP() << "its file has a digest";
  const TypeParam wrote = random_record<kFile, TypeParam>(1);
  auto rows = record::rows_of(std::span<const TypeParam>(&wrote, 1));
  ASSERT_TRUE(rows.is_whole(0));
  for (char& byte : rows.bytes) {
    byte = static_cast<char>(byte ^ 4);
    EXPECT_FALSE(rows.is_whole(0));
    byte = static_cast<char>(byte ^ 4);
  }
}

TYPED_TEST(RecordInRows, of_a_file_that_lacks_a_column_or_has_an_unknown_one_is_read) {
  const TypeParam wrote = random_record<kFile, TypeParam>(3);
  const auto rows = record::rows_of(std::span<const TypeParam>(&wrote, 1));
  const auto& columns = record::columns_of<TypeParam>();
  const h5::LibraryTurn turn;
  for (const auto& left_out : columns) {
    const Folder folder;
    const h5::NewFile file((folder / "rows.h5").c_str());
    // The same row in a type without the column, whose place is called otherwise.
    const h5::Handle now = record::row_type<TypeParam>(), then = h5::compound_type(H5Tget_size(now));
    for (unsigned k = 0; k < static_cast<unsigned>(H5Tget_nmembers(now)); ++k) {
      char* text = H5Tget_member_name(now, k);
      const std::string name = text;
      H5free_memory(text);
      h5::insert_member(then, name == left_out.name ? "a_later_column" : name.c_str(), H5Tget_member_offset(now, k),
                        h5::Handle(H5Tget_member_type(now, k), H5Tclose));
    }
    const hsize_t one = 1;
    h5::write_array(file, "rows", then, {&one, 1}, rows.bytes.data());
    const auto read = record::read_rows<TypeParam>(file, "rows");
    ASSERT_EQ(read.size(), 1U);
    const std::string absent = record::empty_row<TypeParam>(true);
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const bool is_there = columns[c].name != left_out.name;
      EXPECT_EQ(read.known[c] != 0, is_there);
      const char* expected = is_there ? rows.at(0) : absent.data();
      EXPECT_EQ(std::string_view(read.at(0) + columns[c].offset, columns[c].bytes),
                std::string_view(expected + columns[c].offset, columns[c].bytes))
          << columns[c].name << " without " << left_out.name;
    }
  }
}

TYPED_TEST(RecordInAttributes, comes_back_with_every_value) {
  const Folder folder;
  const h5::LibraryTurn turn;
  const h5::NewFile file((folder / "attributes.h5").c_str());
  const auto wrote = random_record<kFile, TypeParam>(5);
  record::write_attributes(file, wrote);
  TypeParam read{};
  record::read_attributes(file, read);
  EXPECT_EQ(memory_of<kFile>(read), memory_of<kFile>(wrote));
}

TYPED_TEST(RecordInJson, comes_back_with_every_value) {
  for (unsigned seed = 0; seed < 100; ++seed) {  // words of every kind among them
    const auto wrote = random_record<kJson, TypeParam>(seed);
    TypeParam read{};
    record::read_json(record::Json::parse(record::json_of(wrote).dump()), read);
    EXPECT_EQ(memory_of<kJson>(read), memory_of<kJson>(wrote));
  }
}

TEST(Records, have_each_name_once) {
  const auto expect_once = [](const auto& columns) {
    std::set<std::string> names;
    for (const auto& column : columns) EXPECT_TRUE(names.insert(column.name).second) << column.name;
  };
  expect_once(record::columns_of<Step>());
  expect_once(record::columns_of<SeedHistory>());
  expect_once(record::columns_of<SeedAct>());
}

TEST(Records, of_seeds_have_a_column_for_each_cause_that_can_occur) {
  for (const SeedCauseWords& words : kSeedCauses) {
    const auto has = [&](const auto& columns) {
      return std::any_of(columns.begin(), columns.end(),
                         [&](const auto& column) { return column.name == std::string(words.column) + "_mm"; });
    };
    EXPECT_EQ(&words_of(words.cause), &words);
    EXPECT_TRUE(has(record::columns_of<SeedHistory>()));
    EXPECT_EQ(has(record::columns_of<SeedAct>()), words.of_drop != nullptr);
    for (const Implant implant : {Implant::permanent, Implant::temporary}) {
      SeedRow shown;
      shown.implant = implant;
      const bool shows = record::csv_header(shown).find(std::string(words.column) + "_x_mm") != std::string::npos;
      EXPECT_EQ(shows, meaning_of(words.cause, implant) != nullptr) << words.name;
      EXPECT_EQ(record::json_of(shown)["why"].contains(words.name), shows) << words.name;
    }
  }
}

namespace {

/// A line of a list in the documents, broken before column 120.
std::string wrapped(const std::string& line, std::size_t indent) {
  constexpr std::size_t kColumns = 120;
  std::string text, rest = line;
  while (rest.size() > kColumns) {
    // Signs of several bytes are one column.
    std::size_t at = 0, columns = 0, space = 0;
    for (; at < rest.size() && columns <= kColumns; ++at) {
      if (rest[at] == ' ' && at > indent) space = at;
      if ((static_cast<unsigned char>(rest[at]) & 0xC0U) != 0x80U) ++columns;
    }
    if (columns <= kColumns) break;
    text += rest.substr(0, space) + "\n";
    rest = std::string(indent, ' ') + rest.substr(space + 1);
  }
  return text + rest + "\n";
}

/// The columns of a table as docs/results lists them: a line for each; those of one meaning share it.
/// @param skip those that another format has
template <record::Format in, class T>
std::string documented(const T& example, std::size_t indent, unsigned skip = 0) {
  std::string text, names, last;
  const auto close = [&] {
    if (!names.empty()) text += wrapped(std::string(indent, ' ') + "- " + names + last, indent + 2);
    names.clear();
  };
  record::each_field<in>(example, [&](const Field& field, const auto& value) {
    if ((field.formats & skip) != 0) return;
    std::string says = *field.unit != '\0' ? std::string(" [") + field.unit + "]" : "";
    says += std::string(": ") + field.meaning;
    if (field.version > 1 && in == kFile) says += "; from version " + std::to_string(field.version) + " on";
    says += ".";
    if (says != last) close();
    last = says;
    using V = std::remove_cvref_t<decltype(value)>;
    const bool is_vector = std::same_as<V, Vec3> || std::same_as<V, std::optional<Vec3>>;
    const bool is_apart = is_vector && (field.is_apart || in == kCsv);
    for (std::size_t k = 0; k < (is_apart ? 3U : 1U); ++k)
      names +=
          (names.empty() ? "`" : ", `") + record::name_of(is_apart ? field.of(record::kComponents[k]) : field) + "`";
    if (is_vector && !is_apart) names += " (3)";
  });
  close();
  return text;
}

template <record::Format in, class T>
void expect_documented(const char* where, const T& example, std::size_t indent, unsigned skip = 0) {
  const std::string list = documented<in>(example, indent, skip);
  bool is_there = false;
  for (const auto& page : fs::directory_iterator(STYLET_RESULTS_PAGES))
    is_there = is_there || stylet::test::content_of(page.path()).find(list) != std::string::npos;
  EXPECT_TRUE(is_there) << "a page of docs/results must have of " << where << ":\n" << list;
}

}  // namespace

TEST(Records, have_their_columns_in_the_documents) {
  expect_documented<kCsv>("forces.csv", Step{}, 0);
  expect_documented<kCsv>("gland.csv", GlandStep{}, 0);
  expect_documented<kFile>("/steps", Step{}, 2, kCsv);
  expect_documented<kFile>("/frames/table", FrameRow{}, 2);
  expect_documented<kFile>("/frames/contacts", ContactView{}, 2);
  expect_documented<kFile>("/events", Event{}, 2);
  expect_documented<kFile>("/probe", ProbeMove{}, 2);
  expect_documented<kFile>("/end", RunEnd{}, 2);
  expect_documented<kFile>("/implant", RecordedPlan{}, 2);
  expect_documented<kFile>("/implant/needles", RecordedPlan::Needle{}, 2);
  expect_documented<kFile>("/implant/planned_seeds", RecordedPlan::Seed{}, 2);
  expect_documented<kFile>("/implant/acts", SeedAct{}, 2);
  expect_documented<kFile>("/implant/doses", RecordedScore{}, 2);
  SeedRow seed, dwell;
  dwell.implant = Implant::temporary;
  expect_documented<kCsv>("seeds.csv", seed, 0);
  expect_documented<kCsv>("seeds.csv of dwell positions", dwell, 0);
  expect_documented<kCsv>("found.csv", FoundRow{}, 0);
  expect_documented<kFile>("an implant's attributes", ImplantRecord{}, 2);
  expect_documented<kFile>("/needles/000", NeedleHistory{}, 4);
  expect_documented<kFile>("shapes", NeedleShape{}, 4);
  expect_documented<kFile>("/seeds", SeedHistory{}, 2);
}

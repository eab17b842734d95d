// SPDX-License-Identifier: GPL-3.0-or-later
#include "evidence/validate/number_table.hpp"
#include "support/folder.hpp"
#include "support/value_of.hpp"

#include <gtest/gtest.h>

using namespace stylet;
using namespace stylet::validate;
namespace fs = std::filesystem;

namespace {

class NumberTable : public ::testing::Test {
 protected:
  void write(const std::string& text) const { test::write_file(file_, text); }
  test::Folder folder_;
  fs::path file_ = folder_ / "table.csv";
};

}  // namespace

TEST_F(NumberTable, without_a_header_all_columns_are_read) {
  write("0.001,0.5\n0.002, 0.7\r\n");
  const auto columns = test::value_of(read_number_table(file_));
  EXPECT_EQ(columns, (std::vector<std::vector<double>>{{0.001, 0.002}, {0.5, 0.7}}));
}

TEST_F(NumberTable, named_columns_come_in_the_order_asked_for_and_bad_lines_are_left_out) {
  write("a, b,c\n1,2,3\n4,,6\n7,8,9\n10,x,12\n");
  const auto columns = test::value_of(read_number_table(file_, {"b", "a"}));
  EXPECT_EQ(columns, (std::vector<std::vector<double>>{{2, 8}, {1, 7}}));
}

TEST_F(NumberTable, a_missing_column_or_a_table_without_numbers_is_refused) {
  write("a,b\n1,2\n");
  const auto missing = read_number_table(file_, {"c"});
  ASSERT_FALSE(missing.ok());
  EXPECT_NE(missing.error().message().find("'c'"), std::string::npos);
  write("a,b\n");
  EXPECT_FALSE(read_number_table(file_, {"a"}).ok());
}

TEST(Interpolated, is_straight_between_points_and_constant_beyond_them) {
  const std::vector<double> x{0, 1, 3};
  const std::vector<double> y{0, 2, 0};
  EXPECT_DOUBLE_EQ(interpolated(x, y, 0.5), 1.0);
  EXPECT_DOUBLE_EQ(interpolated(x, y, 2.0), 1.0);
  EXPECT_DOUBLE_EQ(interpolated(x, y, -1.0), 0.0);
  EXPECT_DOUBLE_EQ(interpolated(x, y, 9.0), 0.0);
}

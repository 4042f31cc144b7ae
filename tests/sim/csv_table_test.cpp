#include "sim/experiment/peers/csv_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

namespace stagger::sim {
namespace {

class Csv : public ::testing::Test {
 protected:
  std::string write(const std::string& text) {
    const std::string file = ::testing::TempDir() + "csv_table_test_" +
                             ::testing::UnitTest::GetInstance()->current_test_info()->name();
    std::ofstream(file) << text;
    return file;
  }
};

std::string complaint(const auto& action) {
  try {
    action();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return {};
}

TEST_F(Csv, FindsCellsByTheNameOfTheirColumn) {
  const CsvTable table(write("robot,x,y\nbolt,1.5,-2e-3\nother,0,4\n"));
  EXPECT_EQ(table.rows(), 2u);
  EXPECT_EQ(table.text(0, "robot"), "bolt");
  EXPECT_EQ(table.number(0, "y"), -2e-3);
  EXPECT_EQ(table.number(1, "x"), 0.0);
  EXPECT_TRUE(table.has("y"));
  EXPECT_FALSE(table.has("z"));
}

TEST_F(Csv, TellsWhereItIsWrong) {
  const std::string no_number = write("x,y\n1,2\n3,4m\n");
  EXPECT_THAT(complaint([&] { CsvTable(no_number).number(1, "y"); }),
              ::testing::HasSubstr(no_number + ":3: y is no number: 4m"));
  EXPECT_THAT(complaint([&] { CsvTable(no_number).number(0, "z"); }),
              ::testing::HasSubstr("no column z"));
  const std::string ragged = write("x,y\n1,2\n3\n");
  EXPECT_THAT(complaint([&] { CsvTable{ragged}; }), ::testing::HasSubstr(ragged + ":3: 1 values"));
  EXPECT_THAT(complaint([] { CsvTable("no/such/file"); }),
              ::testing::HasSubstr("cannot read no/such/file"));
}

}  // namespace
}  // namespace stagger::sim

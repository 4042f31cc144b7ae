#include "server/cli/list.h"

#include <gmock/gmock.h>

namespace stagger::server {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

std::vector<double> read(const std::string& text) {
  return read_number_list("--angles", text, sim::Range::between(-360.0, 360.0, "degrees"));
}

TEST(NumberList, IsOfNumbersAndRanges) {
  EXPECT_THAT(read("5"), ElementsAre(5.0));
  EXPECT_THAT(read("-90,0.5,1e1"), ElementsAre(-90.0, 0.5, 10.0));
  EXPECT_THAT(read("0:1:0.25"), ElementsAre(0.0, 0.25, 0.5, 0.75, 1.0));
  EXPECT_THAT(read("0:345:100"), ElementsAre(0.0, 100.0, 200.0, 300.0));
  EXPECT_THAT(read("7,0:2:1"), ElementsAre(7.0, 0.0, 1.0, 2.0));
  EXPECT_THAT(read("3:3:1"), ElementsAre(3.0));
}

TEST(NumberList, RefusesNamingOptionValueAndRange) {
  EXPECT_THAT([] { read("0,400"); },
              ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr("--angles"), HasSubstr("400"),
                                                         HasSubstr("-360 to 360 degrees"))));
  for (const char* bad : {"", "a", "1x", "1,", ",1", "nan", "inf", "1:2", "1:2:3:4", "2:1:1",
                          "0:1:0", "0:1:-1", "0:1:nan", "0:360:0.01", "1,1", "0:2:1,2", " 1"}) {
    EXPECT_THAT([&] { read(bad); }, ThrowsMessage<std::invalid_argument>(HasSubstr("--angles")))
        << bad;
  }
}

}  // namespace
}  // namespace stagger::server

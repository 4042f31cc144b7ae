#include "server/http/request_head.h"

#include <gtest/gtest.h>

namespace stagger::server {
namespace {

std::optional<std::size_t> length_with(const std::string& lines) {
  return body_length("POST /content-length:7 HTTP/1.1\r\nHost: [::1]:8080\r\n" + lines + "\r\n");
}

TEST(RequestHead, TellsTheLengthOfItsBody) {
  EXPECT_EQ(length_with("Content-Length: 12\r\n"), 12U);
  EXPECT_EQ(length_with("content-LENGTH:12\r\nX: y\r\n"), 12U);
  EXPECT_EQ(length_with("X: y\nContent-Length \t:\t12 \r\n"), 12U) << "as lenient a reader sees it";
}

TEST(RequestHead, HasNoBodyWhenItTellsOfNone) {
  EXPECT_EQ(length_with(""), 0U);
  EXPECT_EQ(length_with("X-Content-Length: 12\r\n"), 0U);
  EXPECT_EQ(body_length(""), 0U);
}

TEST(RequestHead, LeavesToItsReaderWhatIsNotALength) {
  for (const char* lines :
       {"Transfer-Encoding: chunked\r\n", "Expect: 100-continue\r\nContent-Length: 2\r\n",
        "Content-Length: 2\r\nContent-Length: 2\r\n", "Content-Length: -1\r\n",
        "Content-Length: 1x\r\n", "Content-Length:\r\n",
        "Content-Length: 99999999999999999999\r\n"}) {
    EXPECT_EQ(length_with(lines), std::nullopt) << lines;
  }
}

}  // namespace
}  // namespace stagger::server

#include "server/report/html_page.h"

#include <gmock/gmock.h>

namespace stagger::server {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(HtmlPage, EveryTextIsEscaped) {
  const std::string evil = "<script>&\"";
  Table table;
  table.caption = evil;
  table.columns = {{evil, false}, {evil, true}};
  table.rows = {{{evil}, true}, {{evil, evil}, false}};
  Page page;
  page.title = page.subtitle = evil;
  page.facts = {{evil, evil}};
  page.summary = {Paragraph{evil}, table, Figure{evil, evil, 2, {}}};
  page.sections = {{evil, evil, {}}, {evil, evil, {}}};
  const std::string html = to_html(page);
  EXPECT_THAT(html, Not(HasSubstr("<script")));
  EXPECT_THAT(html, HasSubstr("&lt;script&gt;&amp;&quot;"));
}

TEST(HtmlPage, TablesSayWhatTheirHeadersHead) {
  Table table;
  table.columns = {{"Name", false}, {"Value", true}};
  table.rows = {{{"Group"}, true}, {{"a", "1"}, false}, {{"short"}, false}};
  Page page;
  page.summary = {table};
  const std::string html = to_html(page);
  EXPECT_THAT(html, HasSubstr("<th scope=\"col\">Name</th>"));
  EXPECT_THAT(html, HasSubstr("<th scope=\"rowgroup\" class=\"group\" colspan=\"2\">Group</th>"));
  EXPECT_THAT(html, HasSubstr("<th scope=\"row\">a</th><td class=\"number\">1</td>"));
  EXPECT_THAT(html, HasSubstr("<th scope=\"row\">short</th><td class=\"number\"></td>"));
}

TEST(HtmlPage, PicturesFillThePageSideBySide) {
  EXPECT_GT(picture_width(1), 1000.0);
  EXPECT_LT(2.0 * picture_width(2), picture_width(1));
  EXPECT_LT(3.0 * picture_width(3), picture_width(1));
}

}  // namespace
}  // namespace stagger::server

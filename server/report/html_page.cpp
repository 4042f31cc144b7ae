#include "server/report/html_page.h"

#include <algorithm>

#include "server/report/style.h"

namespace stagger::server {
namespace {

std::string element(const std::string& name, const std::string& text,
                    const std::string& attributes = {}) {
  return "<" + name + attributes + ">" + escaped(text) + "</" + name + ">";
}

class Writer {
 public:
  void operator()(const Paragraph& paragraph) { out += element("p", paragraph.text) + "\n"; }

  void operator()(const Verbatim& verbatim) { out += element("pre", verbatim.text) + "\n"; }

  void operator()(const Table& table) {
    // A table wider than the window scrolls by itself, reachable by the keyboard.
    constexpr std::size_t most_of_short = 12;
    const bool whole = table.rows.size() <= most_of_short;  // no page break in it
    out += "<div class=\"scroll" + std::string(whole ? " whole" : "") +
           "\" tabindex=\"0\" role=\"region\" aria-label=\"" + escaped(table.caption) +
           "\">\n<table" + (table.compact ? " class=\"compact\"" : "") + ">\n" +
           element("caption", table.caption) + "\n<thead>\n<tr>";
    for (const Table::Column& column : table.columns) {
      out += element("th", column.title,
                     column.number ? " scope=\"col\" class=\"number\"" : " scope=\"col\"");
    }
    out += "</tr>\n</thead>\n<tbody>\n";
    bool first = true;
    for (const Table::Row& row : table.rows) {
      if (row.heading) {
        // Each group is a body of its own: that is what the scope refers to.
        if (&row != &table.rows.front()) out += "</tbody>\n<tbody>\n";
        out += "<tr>" +
               element("th", row.cells.front(),
                       " scope=\"rowgroup\" class=\"group\" colspan=\"" +
                           std::to_string(table.columns.size()) + "\"") +
               "</tr>\n";
        first = true;
        continue;
      }
      out += row.id.empty() ? "<tr" : "<tr id=\"" + escaped(row.id) + "\"";
      out += first ? " class=\"first\">" : ">";
      first = false;
      for (std::size_t i = 0; i < table.columns.size(); ++i) {
        const std::string text = i < row.cells.size() ? row.cells[i] : "";
        const std::string look = table.columns[i].number ? " class=\"number\""
                                 : table.columns[i].code ? " class=\"code\""
                                                         : "";
        out += i == 0 ? element("th", text, " scope=\"row\"" + look) : element("td", text, look);
      }
      out += "</tr>\n";
    }
    out += "</tbody>\n</table>\n</div>\n";
  }

  void operator()(const Figure& figure) {
    const int columns = std::clamp(figure.columns, 1, 4);
    out += "<figure id=\"" + escaped(figure.id) + "\">\n";
    if (figure.one_legend) {
      out += "<div class=\"legend\">\n" + legend_of(figure) + "</div>\n";
    }
    out += "<div class=\"pictures columns-" + std::to_string(columns) + "\">\n";
    for (const std::string& picture : pictures_of(figure)) out += picture;
    out += "</div>\n" + element("figcaption", figure.caption) + "\n</figure>\n";
  }

  void blocks(const std::vector<Block>& all) {
    for (const Block& block : all) std::visit(*this, block);
  }

  std::string out;
};

}  // namespace

std::string to_html(const Page& page) {
  Writer writer;
  std::string& out = writer.out;
  out =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n" +
      element("title", page.title) + "\n<style>";
  out += page_style();
  out += "</style>\n</head>\n<body>\n<header>\n" + element("h1", page.title) + "\n" +
         element("p", page.subtitle, " class=\"subtitle\"") + "\n<dl>\n";
  for (const auto& [name, value] : page.facts) {
    out += element("dt", name) + element("dd", value) + "\n";
  }
  out += "</dl>\n";
  if (page.sections.size() > 1) {
    out += "<nav aria-label=\"Sections\">";
    for (const Section& section : page.sections) {
      out += element("a", section.title, " href=\"#" + escaped(section.id) + "\"");
    }
    out += "</nav>\n";
  }
  out += "</header>\n<main>\n";
  writer.blocks(page.summary);
  for (const Section& section : page.sections) {
    out += "<section id=\"" + escaped(section.id) + "\">\n" + element("h2", section.title) + "\n";
    writer.blocks(section.blocks);
    out += "</section>\n";
  }
  out += "</main>\n</body>\n</html>\n";
  return std::move(out);
}

}  // namespace stagger::server

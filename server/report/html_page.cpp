#include "server/report/html_page.h"

#include <algorithm>

#include "server/report/svg.h"

namespace stagger::server {
namespace {

constexpr double page_width = 1080.0;
constexpr double column_gap = 28.0;

// Colours by meaning. The light ones print; the tones of blue stay apart in greys as well.
constexpr const char* style = R"(
:root {
  color-scheme: light dark;
  --page: #ffffff; --text: #1a1e22; --muted: #57616a; --rule: #d8dde2; --grid: #e6e9ec;
  --strong: #12356b; --measured: #1f6fd0; --soft: #8ab6ea; --reference: #7d8790;
  --planned: #7042b8; --limit: #c2252b;
}
@media (prefers-color-scheme: dark) {
  :root {
    --page: #14171a; --text: #e8eaed; --muted: #a3acb5; --rule: #363d44; --grid: #2a3036;
    --strong: #d6e6ff; --measured: #62adff; --soft: #3a6ea8; --reference: #98a2ab;
    --planned: #b99aff; --limit: #ff7070;
  }
}
* { box-sizing: border-box; }
body {
  margin: 0 auto; padding: 56px 24px 80px; max-width: 1128px; background: var(--page);
  color: var(--text); font: 15px/1.55 system-ui, "Segoe UI", Roboto, "Helvetica Neue", Arial,
  sans-serif; font-variant-numeric: tabular-nums;
}
h1 { margin: 0; font-size: 30px; line-height: 1.2; letter-spacing: -0.015em; }
h2 {
  margin: 64px 0 8px; padding-top: 20px; border-top: 1px solid var(--rule); font-size: 21px;
  letter-spacing: -0.01em;
}
p { margin: 10px 0; max-width: 76ch; }
a { color: var(--measured); }
nav { margin-top: 18px; }
nav a { display: inline-block; margin-right: 20px; text-decoration: none; }
nav a:hover, nav a:focus { text-decoration: underline; }
.subtitle { margin: 8px 0 0; color: var(--muted); font-size: 16px; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: 3px 20px; margin: 18px 0 0; }
dt { color: var(--muted); }
dd { margin: 0; }
.scroll { overflow-x: auto; margin: 26px 0 0; }
table { width: 100%; border-collapse: collapse; font-size: 14px; line-height: 1.4; }
table.compact { width: auto; }
.compact tbody th { min-width: 0; }
.compact th:nth-child(n + 2), .compact td:nth-child(n + 2) { padding-left: 44px; }
caption { padding-bottom: 8px; color: var(--muted); text-align: left; font-size: 14px; }
th, td { padding: 2px 0 2px 20px; text-align: left; vertical-align: baseline; }
th:first-child, td:first-child { padding-left: 0; }
thead th { padding-bottom: 6px; border-bottom: 1px solid var(--text); font-weight: 600; }
tbody th { min-width: 11em; font-weight: 400; }
tbody tr + tr th, tbody tr + tr td { border-top: 1px solid var(--grid); }
tbody th.group {
  padding-top: 11px; border-top: 0; border-bottom: 1px solid var(--rule); font-weight: 600;
}
tbody tr.first th, tbody tr.first td { border-top: 0; }
.number { text-align: right; white-space: nowrap; }
figure { margin: 30px 0 0; }
figcaption { margin-top: 12px; max-width: 96ch; color: var(--muted); font-size: 14px; }
.pictures { display: grid; gap: 26px 28px; align-items: start; }
.columns-2 { grid-template-columns: repeat(2, minmax(0, 1fr)); }
.columns-3 { grid-template-columns: repeat(3, minmax(0, 1fr)); }
.columns-4 { grid-template-columns: repeat(4, minmax(0, 1fr)); }
.legend > svg { display: block; width: 560px; max-width: 100%; height: auto; margin-bottom: 8px; }
.pictures > svg { display: block; width: 100%; height: auto; }
@media (max-width: 760px) {
  .columns-2, .columns-3, .columns-4 { grid-template-columns: minmax(0, 1fr); }
}
svg text { fill: var(--text); font-size: 12px; }
svg .title { font-size: 13px; font-weight: 600; }
svg .tick, svg .axis { fill: var(--muted); }
svg .note { font-size: 11px; }
.line { fill: none; stroke-linejoin: round; stroke-linecap: butt; }
.dashed { stroke-dasharray: 5 3.5; }
.area { stroke: none; }
.line.strong { stroke: var(--strong); } .area.strong { fill: var(--strong); }
.line.measured { stroke: var(--measured); } .area.measured { fill: var(--measured); }
.line.soft { stroke: var(--soft); } .area.soft { fill: var(--soft); }
.line.reference { stroke: var(--reference); } .area.reference { fill: var(--reference); }
.line.planned { stroke: var(--planned); } .area.planned { fill: var(--planned); }
.line.limit { stroke: var(--limit); } .area.limit { fill: var(--limit); }
.line.ground { stroke: var(--grid); } .area.ground { fill: var(--grid); }
.line.ink { stroke: var(--text); } .area.ink { fill: var(--text); }
footer { margin-top: 64px; padding-top: 16px; border-top: 1px solid var(--rule); color: var(--muted);
  font-size: 13px; }
@page { size: A4; margin: 16mm 15mm; }
@media print {
  :root {
    color-scheme: light;
    --page: #ffffff; --text: #000000; --muted: #4a535b; --rule: #c4cad0; --grid: #e2e5e8;
    --strong: #12356b; --measured: #1f6fd0; --soft: #8ab6ea; --reference: #7d8790;
    --planned: #7042b8; --limit: #c2252b;
  }
  body { max-width: none; padding: 0; font-size: 10pt; print-color-adjust: exact;
    -webkit-print-color-adjust: exact; }
  nav { display: none; }
  .scroll { overflow: visible; }
  table { font-size: 8pt; }
  th, td { padding: 1px 0 1px 10px; }
  tbody { break-inside: avoid; }
  figcaption, caption { font-size: 8.5pt; }
  h2 { margin-top: 28pt; break-after: avoid; }
  figure, tr, dl, .compact { break-inside: avoid; }
  th.group { break-after: avoid; }
  thead { display: table-header-group; }
  .columns-2 { grid-template-columns: repeat(2, minmax(0, 1fr)); }
  .columns-3, .columns-4 { grid-template-columns: repeat(3, minmax(0, 1fr)); }
}
)";

std::string element(const std::string& name, const std::string& text,
                    const std::string& attributes = {}) {
  return "<" + name + attributes + ">" + escaped(text) + "</" + name + ">";
}

class Writer {
 public:
  void operator()(const Paragraph& paragraph) { out += element("p", paragraph.text) + "\n"; }

  void operator()(const Table& table) {
    // A table wider than the window scrolls by itself, reachable by the keyboard.
    out += "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"" +
           escaped(table.caption) + "\">\n<table" + (table.compact ? " class=\"compact\"" : "") +
           ">\n" + element("caption", table.caption) + "\n<thead>\n<tr>";
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
      out += first ? "<tr class=\"first\">" : "<tr>";
      first = false;
      for (std::size_t i = 0; i < table.columns.size(); ++i) {
        const std::string text = i < row.cells.size() ? row.cells[i] : "";
        const std::string number = table.columns[i].number ? " class=\"number\"" : "";
        out +=
            i == 0 ? element("th", text, " scope=\"row\"" + number) : element("td", text, number);
      }
      out += "</tr>\n";
    }
    out += "</tbody>\n</table>\n</div>\n";
  }

  void operator()(const Figure& figure) {
    const int columns = std::clamp(figure.columns, 1, 4);
    out += "<figure id=\"" + escaped(figure.id) + "\">\n";
    if (!figure.legend.empty()) {
      out += "<div class=\"legend\">\n" + figure.legend + "</div>\n";
    }
    out += "<div class=\"pictures columns-" + std::to_string(columns) + "\">\n";
    for (const std::string& picture : figure.pictures) out += picture;
    out += "</div>\n" + element("figcaption", figure.caption) + "\n</figure>\n";
  }

  void blocks(const std::vector<Block>& all) {
    for (const Block& block : all) std::visit(*this, block);
  }

  std::string out;
};

}  // namespace

double picture_width(int columns) {
  return (page_width - column_gap * (columns - 1)) / std::max(columns, 1);
}

std::string to_html(const Page& page) {
  Writer writer;
  std::string& out = writer.out;
  out =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n" +
      element("title", page.title) + "\n<style>";
  out += style;
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

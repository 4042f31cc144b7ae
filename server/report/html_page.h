// A report as one HTML file that needs nothing else: no network, no script. It is XML as well, so
// that tools can check and read it.
#pragma once

#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "server/report/figure.h"

namespace stagger::server {

struct Paragraph {
  std::string text;
};

/// To be read letter by letter: a specification, a command.
struct Verbatim {
  std::string text;
};

struct Table {
  struct Column {
    std::string title;
    bool number = false;  ///< aligned to the right
    bool code = false;    ///< to be copied letter by letter
  };
  struct Row {
    std::vector<std::string> cells;  ///< the first one heads the row
    bool heading = false;            ///< one cell across the table, over the rows that follow
    std::string id = "";             ///< to be linked to; unique in the page, or empty
  };
  std::string caption;
  std::vector<Column> columns;
  std::vector<Row> rows;
  bool compact = false;  ///< as wide as its text, instead of the page
};

using Block = std::variant<Paragraph, Verbatim, Table, Figure>;

struct Section {
  std::string id;
  std::string title;
  std::vector<Block> blocks;
};

struct Page {
  std::string title;
  std::string subtitle;
  std::vector<std::pair<std::string, std::string>> facts;  ///< conditions: name and value
  std::vector<Block> summary;                              ///< before the first section
  std::vector<Section> sections;
};

std::string to_html(const Page& page);

}  // namespace stagger::server

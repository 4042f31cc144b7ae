// A report as one HTML file that needs nothing else: no network, no script. It is XML as well, so
// that tools can check and read it.
#pragma once

#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace stagger::server {

struct Paragraph {
  std::string text;
};

struct Table {
  struct Column {
    std::string title;
    bool number = false;  ///< aligned to the right
  };
  struct Row {
    std::vector<std::string> cells;  ///< the first one heads the row
    bool heading = false;            ///< one cell across the table, over the rows that follow
  };
  std::string caption;
  std::vector<Column> columns;
  std::vector<Row> rows;
  bool compact = false;  ///< as wide as its text, instead of the page
};

/// Pictures side by side with one caption under them.
struct Figure {
  std::string id;
  std::string caption;
  int columns = 2;                    ///< 1 to 4 on a wide page
  std::vector<std::string> pictures;  ///< SVG elements
  std::string legend = "";            ///< SVG element over all of them, or nothing
};

/// Width of a picture that is shown one to one in a figure of so many columns [px].
double picture_width(int columns);
/// Width of a legend that fits on a narrow page as well [px].
inline constexpr double legend_width = 560.0;

using Block = std::variant<Paragraph, Table, Figure>;

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

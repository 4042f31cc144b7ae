#include "server/report/style.h"

#include <array>

namespace stagger::server {
namespace {

/// By meaning; the names are those of `Ink` and of the page's own parts.
struct Colour {
  const char* name;
  const char* light;  ///< prints; the tones of blue stay apart in greys as well
  const char* dark;
};
constexpr Colour ink{"ink", "#1a1e22", "#e8eaed"};
constexpr Colour muted{"muted", "#57616a", "#a3acb5"};
constexpr Colour page{"page", "#ffffff", "#14171a"};
constexpr std::array<Colour, 11> colours{{ink,
                                          muted,
                                          page,
                                          {"rule", "#d8dde2", "#363d44"},
                                          {"ground", "#e2e5e8", "#2a3036"},
                                          {"strong", "#12356b", "#d6e6ff"},
                                          {"measured", "#1f6fd0", "#62adff"},
                                          {"soft", "#8ab6ea", "#3a6ea8"},
                                          {"reference", "#7d8790", "#98a2ab"},
                                          {"planned", "#7042b8", "#b99aff"},
                                          {"limit", "#c2252b", "#ff7070"}}};

constexpr const char* page_rules = R"(
* { box-sizing: border-box; }
body {
  margin: 0 auto; padding: 56px 24px 80px; max-width: 1128px; background: var(--page);
  color: var(--ink); font: 15px/1.55 system-ui, "Segoe UI", Roboto, "Helvetica Neue", Arial,
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
.compact tbody th, tbody th.number { min-width: 0; }
.compact th:nth-child(n + 2), .compact td:nth-child(n + 2) { padding-left: 44px; }
caption { padding-bottom: 8px; color: var(--muted); text-align: left; font-size: 14px; }
th, td { padding: 2px 0 2px 20px; text-align: left; vertical-align: baseline; }
th:first-child, td:first-child { padding-left: 0; }
thead th { padding-bottom: 6px; border-bottom: 1px solid var(--ink); font-weight: 600; }
tbody th { min-width: 11em; font-weight: 400; }
tbody tr + tr th, tbody tr + tr td { border-top: 1px solid var(--ground); }
tbody th.group {
  padding-top: 11px; border-top: 0; border-bottom: 1px solid var(--rule); font-weight: 600;
}
tbody tr.first th, tbody tr.first td { border-top: 0; }
.number { text-align: right; white-space: nowrap; }
.code, pre { font: 12px/1.45 ui-monospace, "DejaVu Sans Mono", monospace; }
.code { overflow-wrap: anywhere; }
td.code { min-width: 26em; }
pre { margin: 18px 0 0; white-space: pre-wrap; overflow-wrap: anywhere; }
tr:target th, tr:target td { background: var(--ground); }
figure { margin: 30px 0 0; }
figcaption { margin-top: 12px; max-width: 96ch; color: var(--muted); font-size: 14px; }
.pictures { display: grid; gap: 26px 28px; align-items: start; }
.columns-1 { grid-template-columns: minmax(0, max-content); }
.columns-2 { grid-template-columns: repeat(2, minmax(0, max-content)); }
.columns-3 { grid-template-columns: repeat(3, minmax(0, max-content)); }
.columns-4 { grid-template-columns: repeat(4, minmax(0, max-content)); }
.legend > svg, .pictures > svg { display: block; max-width: 100%; height: auto; }
.legend > svg { margin-bottom: 8px; }
@media (max-width: 760px) {
  .columns-2, .columns-3, .columns-4 { grid-template-columns: minmax(0, max-content); }
}
@page { size: A4; margin: 16mm 15mm; }
@media print {
  body { max-width: none; padding: 0; font-size: 10pt; print-color-adjust: exact;
    -webkit-print-color-adjust: exact; }
  nav { display: none; }
  .scroll { overflow: visible; }
  table { font-size: 8pt; }
  .code, pre { font-size: 7pt; }
  td.code { min-width: 18em; }
  th, td { padding: 1px 0 1px 10px; }
  tbody:not(:only-of-type), .whole { break-inside: avoid; }
  .legend > svg { max-width: 70%; }
  figcaption, caption { font-size: 8.5pt; }
  h1 { font-size: 18pt; }
  .subtitle { font-size: 11pt; }
  h2 { margin-top: 22pt; padding-top: 10pt; font-size: 13pt; break-after: avoid; }
  figure, tr, dl { break-inside: avoid; }
  th.group { break-after: avoid; }
  thead { display: table-header-group; }
  .columns-2 { grid-template-columns: repeat(2, minmax(0, max-content)); }
  .columns-3, .columns-4 { grid-template-columns: repeat(3, minmax(0, max-content)); }
}
)";

/// For pictures; each ink's colour follows.
constexpr const char* picture_rules = R"(
svg text { font-size: 12px; }
svg .title { font-size: 13px; font-weight: 600; }
svg .note, svg .foot { font-size: 11px; pointer-events: none; }
svg .clear { paint-order: stroke; stroke-width: 3px; stroke-linejoin: round; }
svg a { cursor: pointer; }
.line { fill: none; stroke-linejoin: round; stroke-linecap: butt; }
.dashed { stroke-dasharray: 5 3.5; }
.area { stroke: none; }
)";

std::string variables(const char* Colour::*shade) {
  std::string text;
  for (const Colour& colour : colours) {
    text += std::string(" --") + colour.name + ": " + colour.*shade + ";";
  }
  return text;
}

/// `value`: a colour as CSS has it.
template <typename Value>
std::string ink_rules(const Value& value) {
  std::string text = "svg text { fill: " + value(ink) +
                     "; }\nsvg .tick, svg .axis, svg .foot { fill: " + value(muted) +
                     "; }\nsvg .clear { stroke: " + value(page) + "; }\n";
  for (const Colour& colour : colours) {
    text += std::string(".line.") + colour.name + " { stroke: " + value(colour) + "; } .area." +
            colour.name + " { fill: " + value(colour) + "; }\n";
  }
  return text;
}

}  // namespace

std::string page_style() {
  return "\n:root { color-scheme: light dark;" + variables(&Colour::light) +
         " }\n@media (prefers-color-scheme: dark) {\n:root {" + variables(&Colour::dark) +
         " }\n}\n@media print {\n:root { color-scheme: light;" + variables(&Colour::light) +
         " }\n}" + page_rules + picture_rules +
         ink_rules([](const Colour& colour) { return std::string("var(--") + colour.name + ")"; });
}

std::string figure_style() {
  return std::string("\nsvg { font-family: Helvetica, Arial, \"DejaVu Sans\", sans-serif; }") +
         picture_rules + ink_rules([](const Colour& colour) { return std::string(colour.light); });
}

}  // namespace stagger::server

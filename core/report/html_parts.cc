#include "core/report/html_parts.h"

#include <fmt/format.h>

#include "core/report/text.h"

namespace dispersa {
namespace {

/// A string of CSS: what could end it, or the style sheet around it, as an escape.
std::string CssString(std::string_view text) {
  std::string css = "\"";
  for (const char c : text) {
    const bool plain = c != '"' && c != '\\' && c != '<' && static_cast<unsigned char>(c) >= 0x20;
    css += plain ? std::string(1, c) : fmt::format("\\{:06x}", static_cast<unsigned char>(c));
  }
  return css + "\"";
}

}  // namespace

std::string Tile(const std::string& value, const std::string& label) {
  return fmt::format("<div class=\"tile\"><b>{}</b><span>{}</span></div>", value, label);
}

std::string Code(const std::string& text) { return "<code>" + HtmlText(text) + "</code>"; }

std::string WithUnit(double value, const std::string& unit) {
  return ReadableText(value) + (unit.empty() ? "" : " " + unit);
}

void HtmlTable::Row(const std::vector<std::string>& cells, std::string_view row_class) {
  rows_ += row_class.empty() ? std::string("<tr>") : fmt::format("<tr class=\"{}\">", row_class);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    rows_ += fmt::format("<td{}>{}</td>", columns_[i].number ? " class=\"n\"" : "", cells[i]);
  }
  rows_ += "</tr>\n";
}

void HtmlTable::Wide(const std::string& cell, std::string_view row_class) {
  rows_ +=
      fmt::format("<tr class=\"{}\"><td colspan=\"{}\">{}</td></tr>\n", row_class, columns_.size(), cell);
}

std::string HtmlTable::Html(std::string_view table_class) const {
  std::string head;
  for (const Column& column : columns_) {
    head += fmt::format("<th{}>{}</th>", column.number ? " class=\"n\"" : "", column.title);
  }
  return fmt::format(
      "<div class=\"scroll\"><table{}><thead><tr>{}</tr></thead>\n<tbody>\n{}</tbody></table></div>\n",
      table_class.empty() ? "" : fmt::format(" class=\"{}\"", table_class), head, rows_);
}

std::string Figure(const std::string& svg, const std::string& caption_html) {
  return fmt::format("<figure>{}<figcaption>{}</figcaption></figure>\n", svg, caption_html);
}

std::string VerdictBadge(std::string_view verdict) {
  const std::string_view sign = verdict == "pass"           ? "✓"
                                : verdict == "fail"         ? "✗"
                                : verdict == "inconclusive" ? "?"
                                : verdict == "study"        ? "◇"
                                                            : "…";
  return fmt::format("<span class=\"badge {}\">{} {}</span>", verdict, sign, verdict);
}

std::string PageHead(const std::string& title, const std::string& footer, const std::string& more_style) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\">\n<title>{} – dispersa</title>\n<style>{}{}\n"
      "@page {{ @bottom-left {{ content: {}; }} @bottom-right {{ content: counter(page) \" / \" counter(pages); }} }}"
      "\n</style>\n</head>\n<body>\n",
      HtmlText(title), StyleSheet(), more_style, CssString(footer));
}

std::string_view StyleSheet() {
  return R"css(
:root { color-scheme: light dark; --paper: #ffffff; --ink: #1a2230; --soft: #5b6675; --rule: #d8dee6;
  --panel: #f5f7fa;
  --blue: #1f5fa8; --orange: #c8621b; --green: #2d7d46; --violet: #7350a8; --limit: #c0272d;
  --outer: #cfe0f3; --inner: #92b9e3; --bar: #6f9fd0;
  --pass: #1e7a3c; --fail: #b3242a; --open: #9a6700; }
@media (prefers-color-scheme: dark) { :root { --paper: #12161c; --ink: #e3e8ef; --soft: #9aa6b5; --rule:
  #323a46;
  --panel: #1b212a; --blue: #6cabf0; --orange: #f0994f; --green: #63bd80; --violet: #b394e8; --limit:
  #ff6b6b;
  --outer: #22364e; --inner: #355f8e; --bar: #4a7fb8; --pass: #2f9a55; --fail: #d9484e; --open: #b98310; } }
@media print { :root { color-scheme: light; --paper: #ffffff; --ink: #000000; --soft: #444444; --rule:
  #bbbbbb; --panel: #ffffff;
  --blue: #1f5fa8; --orange: #c8621b; --green: #2d7d46; --violet: #7350a8; --limit: #c0272d;
  --outer: #cfe0f3; --inner: #92b9e3; --bar: #6f9fd0; --pass: #1e7a3c; --fail: #b3242a; --open: #9a6700; } }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 28px 24px 60px; max-width: 1160px; background: var(--paper); color:
  var(--ink);
  font: 15px/1.5 system-ui, "Segoe UI", "Helvetica Neue", Arial, "Liberation Sans", sans-serif; }
h1 { font-size: 27px; margin: 0 0 2px; } h2 { font-size: 20px; margin: 44px 0 8px; padding-bottom: 4px;
  border-bottom: 2px solid var(--rule); } h3 { font-size: 16px; margin: 24px 0 6px; }
p { margin: 6px 0 10px; max-width: 88ch; } .soft, figcaption, .definition { color: var(--soft); }
a { color: var(--blue); } nav { font-size: 13px; margin: 16px 0 0; display: flex;
  flex-wrap: wrap; gap: 4px 14px; } nav a { white-space: nowrap; }
code { font: 12.5px/1.4 ui-monospace, "DejaVu Sans Mono", "Liberation Mono", monospace; overflow-wrap:
  anywhere; }
.command { display: block; background: var(--panel); border: 1px solid var(--rule); border-radius: 5px;
  padding: 6px 10px;
  margin: 6px 0; user-select: all; } td code.copy { user-select: all; white-space: nowrap; }
.headline { display: flex; flex-wrap: wrap; gap: 8px 16px; align-items: center; margin: 16px 0 4px; padding: 12px 16px;
  border-radius: 7px;
  border: 1px solid var(--rule); background: var(--panel); } .headline p { margin: 0; }
.headline .badge { font-size: 17px; padding: 5px 14px; } .headline.exceeded { border: 2px solid var(--fail); }
.badge { display: inline-block; border-radius: 4px; padding: 1px 8px; font-size: 13px; font-weight: 650;
  color: #fff;
  white-space: nowrap; print-color-adjust: exact; -webkit-print-color-adjust: exact; }
.badge.pass { background: var(--pass); } .badge.fail { background: var(--fail); }
.badge.inconclusive, .badge.incomplete, .badge.design, .badge.study { background: var(--open); }
.tiles { display: grid; grid-template-columns: repeat(auto-fit, minmax(150px, 1fr)); gap: 10px; margin:
  14px 0 0; }
.tile { border: 1px solid var(--rule); border-radius: 6px; padding: 7px 12px; } .tile b { display: block;
  font-size: 19px; }
.tile span { font-size: 12.5px; color: var(--soft); }
.scroll { overflow-x: auto; } table { border-collapse: collapse; margin: 8px 0 12px; font-size: 13.5px;
  width: 100%; }
th { text-align: left; font-weight: 600; color: var(--soft); border-bottom: 1.5px solid var(--rule);
  padding: 4px 8px;
  vertical-align: bottom; } td { border-bottom: 1px solid var(--rule); padding: 4px 8px; vertical-align:
  top; }
th:first-child, td:first-child { padding-left: 0; } table.narrow { width: auto; min-width: 420px; }
.n { text-align: right; font-variant-numeric: tabular-nums; } td.n, td.u { white-space: nowrap; }
td > code { white-space: nowrap; }  td.id code { white-space: normal; }
.warnings { margin: 8px 0; padding: 8px 14px 8px 32px; border-left: 4px solid var(--open); background: var(--panel);
  border-radius: 4px; } .warnings li { margin: 2px 0; max-width: 110ch; }
.requirement { border: 1px solid var(--rule); border-radius: 6px; padding: 10px 14px 6px; margin: 10px 0; }
.requirement .claim { max-width: none; } .requirement .claim .badge { margin-right: 8px; }
.requirement .sentence { color: var(--soft); } dl.facts { display: flex; flex-wrap: wrap; margin: 8px 0; gap: 6px 28px; }
dl.facts dt { font-size: 12px; color: var(--soft); } dl.facts dd { margin: 0; font-variant-numeric: tabular-nums; }
.requirement .value { font-weight: 650; }
tr.group td { font-weight: 650; padding-top: 14px; } tr.part td:first-child { padding-left: 18px; }
td .definition { display: block; font-size: 12px; line-height: 1.35; max-width: 46ch; }
ol.tornado { list-style: none; margin: 6px 0 14px; padding: 0; font-size: 13px; columns: 2 420px; column-gap: 28px; }
ol.tornado li { display: flex; flex-wrap: wrap; justify-content: space-between; gap: 0 12px; padding: 3px 0; break-inside: avoid; }
ol.tornado .n { margin-left: auto; } ol.tornado .cause { overflow-wrap: anywhere; } ol.tornado svg { width: 100%; height: 9px; overflow: visible; }
svg .track { fill: var(--panel); } svg .whisker { stroke: var(--ink); stroke-width: 3; }
tr.name td { border-bottom: 0; padding-bottom: 0; } tr.name div { position: sticky; left: 0; width: fit-content;
  max-width: min(110ch, 88vw); } tr.name b { font-weight: 600; }
.figures { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(440px, 100%), 1fr)); gap: 18px 22px;
  margin: 12px 0; }
figure { margin: 0; } figure.wide { grid-column: 1 / -1; overflow-x: auto; } figcaption { font-size: 12.5px; line-height:
  1.4; padding: 0 8px; }
svg.chart { display: block; width: 100%; height: auto; } figure.wide svg.chart { min-width: 700px; }
svg text { font-family: inherit; fill: var(--ink); } svg .label { font-size: 12px; font-weight: 600; }
svg .tick { font-size: 11px; fill: var(--soft); } svg .legend { font-size: 11.5px; }
svg .mark-label { font-size: 10px; fill: var(--soft); }
svg path { fill: none; stroke-linejoin: round; } svg .grid { stroke: var(--rule); stroke-width: 0.7; }
svg .axis { stroke: var(--soft); stroke-width: 1; } svg .mark { stroke: var(--soft); stroke-width: 0.8;
  stroke-dasharray: 2 3; }
svg .shade { fill: var(--panel); } svg .limit { stroke: var(--limit); stroke-width: 1.3; stroke-dasharray:
  7 4; }
svg .bound { stroke: var(--violet); stroke-width: 1.5; stroke-dasharray: 2 2; }
svg .ellipse { stroke: var(--ink); stroke-width: 1; }
svg .line-0 { stroke: var(--blue); stroke-width: 1.6; } svg .line-1 { stroke: var(--orange); stroke-width:
  1.4; }
svg .line-2 { stroke: var(--green); stroke-width: 1.4; } svg .line-3 { stroke: var(--violet); stroke-width:
  1.4; }
svg .dots { stroke: var(--blue); stroke-width: 3.4; stroke-linecap: round; opacity: 0.6; }
svg .dot-nominal { stroke: var(--orange); stroke-width: 8; stroke-linecap: round; }
svg .program { stroke: var(--ink); stroke-width: 1.2; stroke-dasharray: 5 3; }
svg path.band-outer, svg rect.band-outer { fill: var(--outer); stroke: var(--inner); stroke-width: 0.6; }
svg path.band-inner, svg rect.band-inner { fill: var(--inner); stroke: none; }
svg .bar { fill: var(--bar); } svg rect { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
.tip { position: fixed; z-index: 2; padding: 5px 9px; border-radius: 5px; background: var(--ink); color: var(--paper);
  font-size: 12.5px; white-space: pre-line; pointer-events: none; max-width: min(340px, 92vw); }
.hint { font-size: 12.5px; margin: 8px 0 0; max-width: none; } .hint input { width: 8em; font: inherit; }
tr.hit td { background: var(--outer); } code.copied::after { content: " ✓ copied"; color: var(--pass); }
code[data-case], svg.chart[data-mx] .plot { cursor: pointer; }
svg.chart[data-x] .plot { touch-action: pan-y; user-select: none; overflow: hidden; }
svg .hit { stroke: var(--limit); stroke-width: 9; stroke-linecap: round; } svg .hit-line { stroke: var(--limit); stroke-width: 1.6; }
svg .zoom { fill: var(--blue); opacity: 0.15; } svg .plot.dimmed path[data-case] { opacity: 0.35; }
svg .plot.dimmed path.strong { opacity: 1; stroke-width: 2.4; }
svg .marks path, svg.zoomed .plot path { vector-effect: non-scaling-stroke; }
@page { size: A4; margin: 14mm 14mm 16mm; font: 8pt "Liberation Sans", Arial, sans-serif; }
@media print { body { padding: 0; max-width: none; font-size: 10.5pt; } nav, .tip, .hint, svg .marks { display: none; }
  .figures { grid-template-columns: 1fr 1fr; } .tiles { grid-template-columns: repeat(5, 1fr); } .tile b { font-size: 12pt; } figure, tr, .headline, .tile, .requirement { break-inside: avoid; }
  h2, h3, summary, thead { break-after: avoid; } h2 + p, h3 + p { break-before: avoid; break-after: avoid; }
  table { font-size: 6.9pt; } th, td { padding: 2px 3px; } td code { font-size: 6.2pt; }
  td .badge { font-size: 7pt; padding: 0 4px; } td .definition { font-size: 6.6pt; }
  table.statistics td.n .definition { white-space: normal; } tr.name { break-after: avoid; } tr.numbers { break-before: avoid; }
  td > code { white-space: normal; overflow-wrap: normal; } figure.wide svg.chart { min-width: 0; }
  .scroll, figure.wide { overflow: visible; } }
)css";
}

}  // namespace dispersa

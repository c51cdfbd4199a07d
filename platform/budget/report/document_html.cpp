#include <string_view>

#include "platform/budget/report/document.hpp"
#include "platform/budget/report/drawing.hpp"
#include "platform/budget/report/page_style.hpp"
#include "platform/printable.hpp"

namespace glint {
namespace {

std::string_view class_of(Tone tone) {
  constexpr std::string_view names[] = {"", "good", "bad", "faint"};
  return names[static_cast<std::size_t>(tone)];
}

std::string_view class_of(NumberKind kind) {
  constexpr std::string_view names[] = {"", "bound", "estimate", "observed"};
  return names[static_cast<std::size_t>(kind)];
}

std::string_view class_of(Verdict verdict) {
  constexpr std::string_view names[] = {"holds", "fails", "void", "unknown"};
  return names[static_cast<std::size_t>(verdict)];
}

// A separate symbol for each kind, for display and print without colour.
std::string_view mark_of(NumberKind kind) {
  constexpr std::string_view marks[] = {"", "&#9632;&#160;", "&#9670;&#160;", "&#9679;&#160;"};
  return marks[static_cast<std::size_t>(kind)];
}

std::string classes(std::string_view a, std::string_view b) {
  if (a.empty() && b.empty()) return "";
  return " class=\"" + std::string(a) + (a.empty() || b.empty() ? "" : " ") + std::string(b) + '"';
}

// Text between back quotes is code, as in Markdown.
std::string rich(std::string_view text) {
  std::string html;
  bool code = false;
  for (const char c : printable_markup(text)) {
    if (c != '`') {
      html += c;
      continue;
    }
    html += code ? "</code>" : "<code>";
    code = !code;
  }
  return code ? html + "</code>" : html;
}

std::string figure_html(const Illustration& figure) {
  return "<figure id=\"figure-" + figure.name + "\">" + figure.svg + "<figcaption>" +
         rich(figure.caption) + "</figcaption></figure>\n";
}

struct BlockHtml {
  std::string operator()(const Sentence& sentence) const {
    return "<p" + classes(class_of(sentence.tone), "") + '>' + rich(sentence.text) + "</p>\n";
  }
  std::string operator()(const Command& command) const {
    return "<pre><code>" + printable_markup(command.text) + "</code></pre>\n";
  }
  std::string operator()(const Illustration& figure) const { return figure_html(figure); }
  std::string operator()(const FigureGrid& grid) const {
    std::string html = "<div class=\"grid\">\n";
    // The caption of a small figure is part of its drawing; pointers and screen readers show it.
    for (const Illustration& figure : grid.figures) {
      html += "<figure id=\"figure-" + figure.name + "\">" + figure.svg + "</figure>\n";
    }
    return html + "</div>\n";
  }
  std::string operator()(const Table& table) const {
    std::string html;
    if (!table.caption.empty()) html += "<p class=\"caption\">" + rich(table.caption) + "</p>\n";
    html += "<div class=\"scroll\"><table>\n<thead><tr>";
    for (const TableColumn& column : table.columns) {
      html += "<th scope=\"col\"" +
              classes(column.is_number ? "number" : "", class_of(column.kind)) + '>' +
              std::string(mark_of(column.kind)) + rich(column.title) + "</th>";
    }
    html += "</tr></thead>\n<tbody>\n";
    for (const auto& row : table.rows) {
      html += "<tr>";
      for (std::size_t i = 0; i < row.size(); ++i) {
        const bool number = i < table.columns.size() && table.columns[i].is_number;
        html += "<td" + classes(number ? "number" : "", class_of(row[i].tone)) + '>' +
                rich(row[i].text) + "</td>";
      }
      html += "</tr>\n";
    }
    return html + "</tbody></table></div>\n";
  }
};

std::string headline_html(const Headline& headline) {
  const bool words = headline.value.find_first_of("0123456789") == std::string::npos;
  return "<div class=\"tile " + std::string(class_of(headline.kind)) + "\"><div class=\"kind\">" +
         std::string(mark_of(headline.kind)) + name_of(headline.kind) + "</div><div class=\"value" +
         (words ? " words" : "") + "\">" + printable_markup(headline.value) +
         "</div><p class=\"what\">" + printable_markup(headline.what) + "</p><p class=\"from\">" +
         printable_markup(headline.provenance) + "</p></div>\n";
}

}  // namespace

std::string html_of(const Document& document) {
  // The policy forbids every request, whatever the page contains.
  std::string html =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
      "'unsafe-inline'; img-src data:\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"color-scheme\" content=\"light dark\">\n<title>" +
      printable_markup(document.title) + "</title>\n<style>" + std::string(k_figure_colours) +
      std::string(k_figure_style) + std::string(k_page_style) +
      "</style></head>\n<body><div class=\"page\">\n<header><h1>" +
      printable_markup(document.title) + "</h1><p>" + printable_markup(document.subtitle) +
      "</p></header>\n<main>\n";
  html += "<section class=\"verdict " + std::string(class_of(document.verdict)) +
          "\" id=\"verdict\"><div class=\"mark\">" + name_of(document.verdict) + "</div><div><p>" +
          rich(document.verdict_text) + "</p>";
  if (!document.reasons.empty()) {
    html += "<ul>";
    for (const Sentence& reason : document.reasons) {
      html += "<li" + classes(class_of(reason.tone), "") + '>' + rich(reason.text) + "</li>";
    }
    html += "</ul>";
  }
  html += "</div></section>\n<div class=\"tiles\">\n";
  for (const Headline& headline : document.headlines) html += headline_html(headline);
  html += "</div>\n<nav aria-label=\"Sections\"><ol>";
  for (const Section& section : document.sections) {
    html += "<li><a href=\"#" + section.id + "\">" + printable_markup(section.title) + "</a></li>";
  }
  html += "</ol></nav>\n";
  int number = 0;
  for (const Section& section : document.sections) {
    html += "<section id=\"" + section.id + "\"><h2><span class=\"number\">" +
            std::to_string(++number) + "</span>" + printable_markup(section.title) + "</h2>\n";
    for (const Block& block : section.blocks) html += std::visit(BlockHtml{}, block);
    html += "</section>\n";
  }
  return html + "</main></div></body></html>\n";
}

std::string standalone_svg(const Illustration& figure) {
  std::string svg = figure.svg;
  const std::size_t inside = svg.find('>') + 1;
  return svg.insert(inside, "<style>" + std::string(k_figure_colours) +
                                std::string(k_figure_style) +
                                "svg{background:var(--paper)}</style>") +
         "\n";
}

}  // namespace glint

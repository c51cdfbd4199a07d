// Format-independent report: headings, sentences, tables and figures. HTML and Markdown are written
// from it, so that both have the same content.
#pragma once

#include <string>
#include <variant>
#include <vector>

namespace glint {

// Kind of a number; every figure's column states it, so that readers do not confuse them.
enum class NumberKind { none, bound, estimate, observed };

enum class Tone { plain, good, bad, faint };

struct TableCell {
  std::string text;
  Tone tone = Tone::plain;
};

struct TableColumn {
  std::string title;
  NumberKind kind = NumberKind::none;
  bool is_number = false;
};

struct Table {
  std::string caption;
  std::vector<TableColumn> columns;
  std::vector<std::vector<TableCell>> rows;
};

struct Sentence {
  std::string text;
  Tone tone = Tone::plain;
};

struct Command {
  std::string text;  // can be pasted into a shell
};

struct Illustration {
  std::string name;     // of its file beside the Markdown
  std::string caption;  // also the alternative text
  std::string svg;
};

struct FigureGrid {
  std::vector<Illustration> figures;  // small, side by side
};

using Block = std::variant<Sentence, Table, Command, Illustration, FigureGrid>;

struct Section {
  std::string id, title;
  std::vector<Block> blocks;
};

// One of the three figures at the top.
struct Headline {
  NumberKind kind = NumberKind::none;
  std::string value;       // with its unit; "not applicable", "not given"
  std::string what;        // of what
  std::string provenance;  // board, table, build, machine, n
};

enum class Verdict { holds, fails, invalid_bound, not_shown };

struct Document {
  std::string title, subtitle;
  Verdict verdict = Verdict::not_shown;
  std::string verdict_text;
  std::vector<Sentence> reasons;
  std::vector<Headline> headlines;
  std::vector<Section> sections;
};

[[nodiscard]] std::string name_of(NumberKind kind);
[[nodiscard]] std::string name_of(Verdict verdict);

// One self-contained page: no network, no script, no font, no image from outside.
[[nodiscard]] std::string html_of(const Document& document);

// The same as Markdown; it refers to figures as files in `figures/`.
[[nodiscard]] std::string markdown_of(const Document& document);

// All figures, in order.
[[nodiscard]] std::vector<Illustration> figures_of(const Document& document);

// A figure as a separate file, with the page's colours.
[[nodiscard]] std::string standalone_svg(const Illustration& figure);

}  // namespace glint

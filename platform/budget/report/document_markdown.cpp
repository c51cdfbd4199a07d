#include "platform/budget/report/document.hpp"
#include "platform/printable.hpp"

namespace glint {
namespace {

std::string in_table(const std::string& text) {
  std::string line;
  for (const char c : text) {
    if (c == '|') line += '\\';
    line += c == '\n' ? ' ' : c;
  }
  return line;
}

std::string emphasised(const std::string& text, Tone tone) {
  return tone == Tone::bad && !text.empty() ? "**" + text + "**" : text;
}

std::string figure_markdown(const Illustration& figure) {
  return "![" + figure.caption + "](figures/" + figure.name + ".svg)\n\n";
}

struct BlockMarkdown {
  std::string operator()(const Sentence& sentence) const {
    return emphasised(sentence.text, sentence.tone) + "\n\n";
  }
  std::string operator()(const Command& command) const {
    return "```sh\n" + command.text + "\n```\n\n";
  }
  std::string operator()(const Illustration& figure) const {
    return figure_markdown(figure) + figure.caption + "\n\n";
  }
  std::string operator()(const FigureGrid& grid) const {
    std::string text;
    for (const Illustration& figure : grid.figures) text += figure_markdown(figure);
    return text;
  }
  std::string operator()(const Table& table) const {
    std::string text = table.caption.empty() ? "" : table.caption + "\n\n";
    std::string rule = "|";
    text += '|';
    for (const TableColumn& column : table.columns) {
      const std::string kind =
          column.kind == NumberKind::none ? "" : " (" + name_of(column.kind) + ")";
      text += ' ' + in_table(column.title) + kind + " |";
      rule += column.is_number ? " ---: |" : " --- |";
    }
    text += '\n' + rule + '\n';
    for (const auto& row : table.rows) {
      text += '|';
      for (const TableCell& cell : row) {
        text += ' ' + emphasised(in_table(cell.text), cell.tone) + " |";
      }
      text += '\n';
    }
    return text + '\n';
  }
};

}  // namespace

std::string name_of(NumberKind kind) {
  constexpr const char* names[] = {"", "bound", "estimate", "observed"};
  return names[static_cast<std::size_t>(kind)];
}

std::string name_of(Verdict verdict) {
  constexpr const char* names[] = {"HOLDS", "FAILS", "VOID", "NOT SHOWN"};
  return names[static_cast<std::size_t>(verdict)];
}

std::string markdown_of(const Document& document) {
  std::string text = "# " + document.title + "\n\n" + document.subtitle + "\n\n**" +
                     name_of(document.verdict) + ".** " + document.verdict_text + "\n\n";
  for (const Sentence& reason : document.reasons) {
    text += "- " + emphasised(reason.text, reason.tone) + '\n';
  }
  text += "\n| kind | figure | of | from |\n| --- | --- | --- | --- |\n";
  for (const Headline& headline : document.headlines) {
    text += "| " + name_of(headline.kind) + " | " + in_table(headline.value) + " | " +
            in_table(headline.what) + " | " + in_table(headline.provenance) + " |\n";
  }
  int number = 0;
  for (const Section& section : document.sections) {
    text += "\n## " + std::to_string(++number) + ". " + section.title + "\n\n";
    for (const Block& block : section.blocks) text += std::visit(BlockMarkdown{}, block);
  }
  return printable_lines(text);
}

std::vector<Illustration> figures_of(const Document& document) {
  std::vector<Illustration> figures;
  for (const Section& section : document.sections) {
    for (const Block& block : section.blocks) {
      if (const auto* figure = std::get_if<Illustration>(&block)) figures.push_back(*figure);
      if (const auto* grid = std::get_if<FigureGrid>(&block)) {
        figures.insert(figures.end(), grid->figures.begin(), grid->figures.end());
      }
    }
  }
  return figures;
}

}  // namespace glint

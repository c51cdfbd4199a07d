// Programs in the controllers' languages, read back from the published syntax. Shares no code with
// the post-processors: the rotations are products of elementary matrices.
#pragma once

#include <cctype>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace glint::test {

struct ReadMove {
  Eigen::Vector3d position_m;
  Eigen::Matrix3d rotation;
  double speed_m_s = 0;
  double blend_m = 0;
  bool circular = false;
  Eigen::Vector3d via_m = Eigen::Vector3d::Zero();  // of a circular move
  bool along_stroke = false;  // URScript only: the others have one linear move
};

// A user frame in the base, as the program defines it or, in LS, states it.
struct ReadFrame {
  Eigen::Vector3d position_m;
  Eigen::Matrix3d rotation;
};

struct ReadProgram {
  std::string name;
  std::optional<ReadFrame> frame;  // of the moves; empty: the base
  int user_frame = -1, tool_frame = -1;
  double acceleration_m_s2 = -1;
  std::vector<ReadMove> moves;
  std::vector<std::string> comments;  // without their marks
};

// Each throws std::runtime_error naming the line for a text that is not of the dialect.
ReadProgram read_urscript(const std::string& text);
ReadProgram read_krl(const std::string& text);
ReadProgram read_rapid(const std::string& text);
ReadProgram read_ls(const std::string& text);

// Elementary rotations by degrees.
inline Eigen::Matrix3d turned(int axis, double degrees) {
  const double a = degrees * std::numbers::pi / 180;
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
  m(i, i) = m(j, j) = std::cos(a);
  m(i, j) = -std::sin(a);
  m(j, i) = std::sin(a);
  return m;
}

// Reads tokens between blanks. Line feeds are blanks, or tokens of their own ("\n").
class Scanner {
 public:
  Scanner(std::string_view text, bool by_line) : text_(text), by_line_(by_line) {}

  [[noreturn]] void fail(const std::string& expected) const {
    std::size_t line = 1;
    for (std::size_t i = 0; i < at_ && i < text_.size(); ++i) line += text_[i] == '\n' ? 1 : 0;
    throw std::runtime_error("line " + std::to_string(line) + ": expected " + expected);
  }
  [[nodiscard]] bool at_end() {
    skip();
    return at_ >= text_.size();
  }
  // Skips the token, in any case, if it is next. A word ends where no letter follows it.
  bool accept(std::string_view token) {
    skip();
    if (text_.size() - at_ < token.size()) return false;
    for (std::size_t i = 0; i < token.size(); ++i) {
      if (std::toupper(static_cast<unsigned char>(text_[at_ + i])) !=
          std::toupper(static_cast<unsigned char>(token[i]))) {
        return false;
      }
    }
    const std::size_t end = at_ + token.size();
    if (end < text_.size() && in_word(token.back()) && in_word(text_[end])) return false;
    at_ = end;
    return true;
  }
  [[nodiscard]] bool next_is(std::string_view token) {
    const std::size_t begin = at_;
    const bool is = accept(token);
    at_ = begin;
    return is;
  }
  void expect(std::string_view token) {
    if (!accept(token)) fail(token == "\n" ? "the line's end" : "'" + std::string(token) + "'");
  }
  std::string word() {
    skip();
    const std::size_t begin = at_;
    while (at_ < text_.size() && in_word(text_[at_])) ++at_;
    if (begin == at_) fail("a word");
    return std::string(text_.substr(begin, at_ - begin));
  }
  // Decimal number with an optional exponent; no blank after the sign.
  double number() {
    skip();
    const std::size_t begin = at_;
    if (at_ < text_.size() && text_[at_] == '-') ++at_;
    const std::size_t digits = at_;
    while (at_ < text_.size() && (digit() || text_[at_] == '.')) ++at_;
    if (at_ > digits && at_ + 1 < text_.size() && text_[at_] == 'E') {
      ++at_;
      while (at_ < text_.size() && digit()) ++at_;
    }
    const std::string found(text_.substr(begin, at_ - begin));
    char* end = nullptr;
    const double value = std::strtod(found.c_str(), &end);
    if (at_ == digits || *end != 0) fail("a number");
    return value;
  }
  int whole() {
    const double value = number();
    if (value != std::floor(value)) fail("a whole number");
    return static_cast<int>(value);
  }
  // The rest of the line, without its end.
  std::string rest() {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    const std::string found(text_.substr(at_, end - at_));
    at_ = end;
    return found;
  }

 private:
  static bool in_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }
  [[nodiscard]] bool digit() const { return text_[at_] >= '0' && text_[at_] <= '9'; }
  void skip() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\r' ||
                                  (text_[at_] == '\n' && !by_line_))) {
      ++at_;
    }
  }

  std::string_view text_;
  bool by_line_;
  std::size_t at_ = 0;
};

}  // namespace glint::test

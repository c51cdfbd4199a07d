#include "platform/budget/prove/expression.hpp"

#include <cctype>

#include "platform/budget/prove/exact.hpp"
#include "platform/input_error.hpp"

namespace glint::prove {
namespace {

constexpr std::int64_t k_value_max = std::int64_t{1} << 53;

class ExpressionReader {
 public:
  ExpressionReader(std::string_view text, const NamedCounts& names, const std::string& place)
      : text_(text), names_(names), place_(place) {}

  std::int64_t read() {
    const std::int64_t value = sum(0);
    if (next() != '\0') fail("expected an operator at \"" + std::string(text_.substr(at_)) + "\"");
    if (value < 0) fail("is negative");
    return value;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(place_ + ": \"" + std::string(text_) + "\": " + what);
  }

  char next() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }

  std::int64_t checked(std::int64_t value) const {
    if (value > k_value_max || value < -k_value_max) fail("expected a value below 2^53");
    return value;
  }

  std::int64_t sum(int depth) {
    std::int64_t value = product(depth);
    for (char sign = next(); sign == '+' || sign == '-'; sign = next()) {
      ++at_;
      const std::int64_t right = product(depth);
      value = checked(sign == '+' ? value + right : value - right);
    }
    return value;
  }

  std::int64_t product(int depth) {
    std::int64_t value = factor(depth);
    for (char sign = next(); sign == '*' || sign == '/'; sign = next()) {
      ++at_;
      const std::int64_t right = factor(depth);
      if (sign == '/' && (right <= 0 || value < 0)) fail("expected a positive quotient");
      value =
          checked(sign == '*' ? exact_product(value, right) : exact_sum(value, right - 1) / right);
    }
    return value;
  }

  std::int64_t factor(int depth) {
    constexpr int k_depth_max = 16;
    const char first = next();
    if (first == '(') {
      if (depth == k_depth_max) fail("expected at most 16 nested parentheses");
      ++at_;
      const std::int64_t value = sum(depth + 1);
      if (next() != ')') fail("expected )");
      ++at_;
      return value;
    }
    std::string word;
    while (at_ < text_.size() &&
           (std::isalnum(static_cast<unsigned char>(text_[at_])) != 0 || text_[at_] == '_')) {
      word += text_[at_++];
    }
    if (word.empty()) fail("expected a number or a name");
    if (word.find_first_not_of("0123456789") == std::string::npos) {
      if (word.size() > 15) fail("expected a value below 2^53");
      return std::stoll(word);
    }
    const auto found = names_.find(word);
    if (found == names_.end()) fail("unknown name " + word + known_names());
    return found->second;
  }

  std::string known_names() const {
    std::string text;
    for (const auto& [name, value] : names_)
      text += (text.empty() ? "; expected one of " : ", ") + name;
    return text;
  }

  std::string_view text_;
  const NamedCounts& names_;
  const std::string& place_;
  std::size_t at_ = 0;
};

}  // namespace

std::int64_t value_of(std::string_view expression, const NamedCounts& names,
                      const std::string& place) {
  return ExpressionReader(expression, names, place).read();
}

}  // namespace glint::prove

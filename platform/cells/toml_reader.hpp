// Reads one table of a TOML file key by key. Every complaint is one line: file:line: key, what was
// found, what was expected; a key that nobody asked for is refused by name when the table is done.
#pragma once

#include <initializer_list>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace glint {
// Throws what parse_toml catches.
[[noreturn]] void refuse_toml_state();
}  // namespace glint

// toml++ 3.3.0 guards its state by assertions alone, and some files break them: `[`, line feed,
// `d`. It then aborts, or with NDEBUG goes on with undefined behaviour. Here they throw in every
// build.
#define TOML_ENABLE_FORMATTERS 0
#define TOML_ASSERT(state) (static_cast<bool>(state) ? void() : ::glint::refuse_toml_state())
#pragma push_macro("NDEBUG")
#undef NDEBUG
#include <toml++/toml.h>
#pragma pop_macro("NDEBUG")

namespace glint {

// Throws InputError: file:line: the parser's words.
[[nodiscard]] toml::table parse_toml(const std::string& text, const std::string& file);
// Throws InputError where the file cannot be read.
[[nodiscard]] std::string read_text(const std::string& file);

class TomlReader {
 public:
  TomlReader(const toml::table& table, std::string file, std::string section)
      : table_(table), file_(std::move(file)), section_(std::move(section)) {}

  // The value of `key`, or `otherwise` where the key is absent; InputError outside [low, high].
  [[nodiscard]] double real(const char* key, double otherwise, double low, double high);
  [[nodiscard]] std::int64_t integer(const char* key, std::int64_t otherwise, std::int64_t low,
                                     std::int64_t high);
  [[nodiscard]] bool boolean(const char* key, bool otherwise);
  // Names and paths: refuses characters that are not printable (platform/printable.hpp).
  [[nodiscard]] std::string text(const char* key, const std::string& otherwise);
  // Whether `key` is there and a text: for a key that takes a file's name or a table.
  [[nodiscard]] bool is_text(const char* key) const { return table_[key].is_string(); }
  [[nodiscard]] std::string one_of(const char* key, const std::string& otherwise,
                                   std::initializer_list<const char*> allowed);
  // Exactly `count` numbers, or nothing where the key is absent.
  [[nodiscard]] std::optional<std::vector<double>> reals(const char* key, std::size_t count);
  // As many as there are; none where the key is absent.
  [[nodiscard]] std::vector<double> numbers(const char* key);
  [[nodiscard]] std::vector<std::string> texts(const char* key);
  // Pairs of numbers: [[from, to], ..].
  [[nodiscard]] std::vector<std::pair<double, double>> intervals(const char* key);
  [[nodiscard]] const toml::table* table(const char* key);
  // [[key]], or a list of { }; nothing where the key is absent.
  [[nodiscard]] std::vector<const toml::table*> tables(const char* key);

  // Where a key stands in the file; the first line where it is absent.
  [[nodiscard]] std::uint32_t line_of(const char* key) const;

  // Refuses any key that was not read above.
  void done() const;

 private:
  [[noreturn]] void complain(const toml::node& where, const char* key,
                             const std::string& expected) const;
  const toml::node* find(const char* key);

  const toml::table& table_;
  std::string file_;
  std::string section_;
  std::set<std::string> known_;
};

}  // namespace glint

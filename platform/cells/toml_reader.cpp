#include "platform/cells/toml_reader.hpp"

#include <algorithm>
#include <sstream>
#include <string_view>

#include "platform/cells/toml_keys.hpp"
#include "platform/input_error.hpp"
#include "platform/nearest_name.hpp"
#include "platform/printable.hpp"
#include "platform/read_file.hpp"

namespace glint {
namespace {

constexpr const char* k_text_expected = "text in quotes, printable UTF-8";

std::string place(const std::string& file, const toml::source_region& region) {
  return file + ":" + std::to_string(region.begin.line);
}

std::string number_text(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

std::string shown(const toml::node& node) {
  if (const auto text = node.value_exact<std::string>()) return "\"" + *text + "\"";
  if (const auto whole = node.value_exact<std::int64_t>()) return std::to_string(*whole);
  if (const auto real = node.value_exact<double>()) return number_text(*real);
  if (const auto flag = node.value_exact<bool>()) return *flag ? "true" : "false";
  return node.is_array() ? "an array" : node.is_table() ? "a table" : "a date or time";
}

struct BrokenState {};

bool breaks_the_parser(std::string_view text) {
  try {
    (void)toml::parse(text);
  } catch (const BrokenState&) {
    return true;
  } catch (const toml::parse_error&) {
  }
  return false;
}

// Returns the first line that violates the parser's assertions, by bisection: the parser reads
// forwards, so every longer prefix violates them too.
std::size_t line_that_breaks(const std::string& text) {
  std::vector<std::size_t> ends;  // of lines
  for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 1)) {
    ends.push_back(at + 1);
  }
  const auto first = std::partition_point(ends.begin(), ends.end(), [&](std::size_t end) {
    return !breaks_the_parser(std::string_view(text).substr(0, end));
  });
  return static_cast<std::size_t>(first - ends.begin()) + 1;
}

}  // namespace

std::string read_text(const std::string& file) {
  return read_file(file, k_text_bytes_max, "a TOML file");
}

void throw_toml_assertion() { throw BrokenState(); }

toml::table parse_toml(const std::string& text, const std::string& file) {
  check_key_parts(text, file);
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    throw InputError(place(file, error.source()) + ": " + std::string(error.description()) +
                     "; expected TOML");
  } catch (const BrokenState&) {
    throw InputError(file + ":" + std::to_string(line_that_breaks(text)) +
                     ": invalid text; expected TOML");
  }
}

void TomlReader::throw_input_error(const toml::node& where, const char* key,
                                   const std::string& expected) const {
  throw InputError(place(file_, where.source()) + ": " + section_ + key + " is " + shown(where) +
                   "; expected " + expected);
}

const toml::node* TomlReader::find(const char* key) {
  read_keys_.insert(key);
  return table_.get(key);
}

double TomlReader::real(const char* key, double otherwise, double low, double high) {
  const toml::node* node = find(key);
  if (node == nullptr) return otherwise;
  const auto value = node->value<double>();
  if (!value || !(*value >= low && *value <= high)) {
    throw_input_error(*node, key, "a number from " + number_text(low) + " to " + number_text(high));
  }
  return *value;
}

std::int64_t TomlReader::integer(const char* key, std::int64_t otherwise, std::int64_t low,
                                 std::int64_t high) {
  const toml::node* node = find(key);
  if (node == nullptr) return otherwise;
  const auto value = node->value_exact<std::int64_t>();
  if (!value || *value < low || *value > high) {
    throw_input_error(*node, key,
                      "a whole number from " + std::to_string(low) + " to " + std::to_string(high));
  }
  return *value;
}

bool TomlReader::boolean(const char* key, bool otherwise) {
  const toml::node* node = find(key);
  if (node == nullptr) return otherwise;
  const auto value = node->value_exact<bool>();
  if (!value) throw_input_error(*node, key, "true or false");
  return *value;
}

std::string TomlReader::text(const char* key, const std::string& otherwise) {
  const toml::node* node = find(key);
  if (node == nullptr) return otherwise;
  const auto value = node->value_exact<std::string>();
  if (!value || printable(*value) != *value) throw_input_error(*node, key, k_text_expected);
  return *value;
}

std::string TomlReader::one_of(const char* key, const std::string& otherwise,
                               std::initializer_list<const char*> allowed) {
  const std::string value = text(key, otherwise);
  std::string list;
  for (const char* option : allowed) {
    if (value == option) return value;
    list += (list.empty() ? "\"" : ", \"") + std::string(option) + "\"";
  }
  throw_input_error(*table_.get(key), key, "one of " + list);
}

std::optional<std::vector<double>> TomlReader::reals(const char* key, std::size_t count) {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  const std::string expected = std::to_string(count) + " numbers in [ ]";
  const toml::array* array = node->as_array();
  if (array == nullptr || array->size() != count) throw_input_error(*node, key, expected);
  std::vector<double> values;
  for (const toml::node& item : *array) {
    const auto value = item.value<double>();
    if (!value || !(*value > -1e12 && *value < 1e12)) throw_input_error(item, key, expected);
    values.push_back(*value);
  }
  return values;
}

std::vector<double> TomlReader::numbers(const char* key) {
  const toml::node* node = find(key);
  if (node == nullptr) return {};
  const toml::array* array = node->as_array();
  if (array == nullptr) throw_input_error(*node, key, "a list of numbers in [ ]");
  return reals(key, array->size()).value_or(std::vector<double>{});
}

std::vector<std::string> TomlReader::texts(const char* key) {
  std::vector<std::string> values;
  const toml::node* node = find(key);
  if (node == nullptr) return values;
  const toml::array* array = node->as_array();
  if (array == nullptr) throw_input_error(*node, key, "a list of texts in [ ]");
  for (const toml::node& item : *array) {
    const auto value = item.value_exact<std::string>();
    if (!value || printable(*value) != *value) throw_input_error(item, key, k_text_expected);
    values.push_back(*value);
  }
  return values;
}

std::vector<std::pair<double, double>> TomlReader::intervals(const char* key) {
  std::vector<std::pair<double, double>> values;
  const toml::node* node = find(key);
  if (node == nullptr) return values;
  const std::string expected = "a list of [from, to] with from < to";
  const toml::array* array = node->as_array();
  if (array == nullptr) throw_input_error(*node, key, expected);
  for (const toml::node& item : *array) {
    const toml::array* pair = item.as_array();
    if (pair == nullptr || pair->size() != 2) throw_input_error(item, key, expected);
    const auto from = pair->get(0)->value<double>();
    const auto to = pair->get(1)->value<double>();
    if (!from || !to || !(*from < *to)) throw_input_error(item, key, expected);
    values.emplace_back(*from, *to);
  }
  return values;
}

const toml::table* TomlReader::table(const char* key) {
  const toml::node* node = find(key);
  if (node == nullptr) return nullptr;
  if (!node->is_table()) throw_input_error(*node, key, "a table [" + section_ + key + "]");
  return node->as_table();
}

std::vector<const toml::table*> TomlReader::tables(const char* key) {
  std::vector<const toml::table*> values;
  const toml::node* node = find(key);
  if (node == nullptr) return values;
  const toml::array* array = node->as_array();
  if (array == nullptr) throw_input_error(*node, key, "a list of tables");
  for (const toml::node& item : *array) {
    if (!item.is_table()) throw_input_error(item, key, "a table in { }");
    values.push_back(item.as_table());
  }
  return values;
}

std::uint32_t TomlReader::line_of(const char* key) const {
  const toml::node* node = table_.get(key);
  return node == nullptr ? 1 : node->source().begin.line;
}

void TomlReader::done() const {
  for (const auto& [key, node] : table_) {
    const std::string name(key.str());
    if (read_keys_.count(name) != 0) continue;
    std::string list;
    for (const std::string& known : read_keys_) list += (list.empty() ? "" : ", ") + known;
    throw InputError(place(file_, node.source()) + ": unknown key " + section_ + name +
                     nearest_name_text(name, {read_keys_.begin(), read_keys_.end()}) +
                     "; expected one of " + list);
  }
}

}  // namespace glint

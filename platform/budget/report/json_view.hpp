// JSON reader with error positions: a missing value or a wrong type throws with the file, the path
// to the value and what was expected.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace glint {

class JsonView {
 public:
  // Throws InputError with file and line if the file cannot be read or is no JSON object.
  [[nodiscard]] static JsonView of_file(const std::string& path);

  [[nodiscard]] bool has(const char* key) const;
  // Value at a key; these functions throw InputError if it is missing or has another type.
  [[nodiscard]] JsonView at(const char* key) const;
  [[nodiscard]] std::string text(const char* key) const;
  [[nodiscard]] double number(const char* key) const;
  // Items of a list, or of an object in the file's order; empty if the key is absent.
  [[nodiscard]] std::vector<JsonView> list(const char* key) const;

  // The same for an optional key.
  [[nodiscard]] std::string text_or(const char* key, const std::string& otherwise) const;
  [[nodiscard]] double number_or(const char* key, double otherwise) const;
  // For a value that may be null or absent: then NaN.
  [[nodiscard]] double number_or_none(const char* key) const;

  // Properties of this value: its key in the object it was listed from, its text or number.
  [[nodiscard]] const std::string& key() const { return key_; }
  [[nodiscard]] bool is_number() const { return value_->is_number(); }
  [[nodiscard]] std::string as_text() const;
  [[nodiscard]] double as_number() const;

  [[nodiscard]] const std::string& file() const { return *file_; }

 private:
  JsonView() = default;
  [[noreturn]] void refuse(const std::string& place, const std::string& found,
                           const char* expected) const;
  [[nodiscard]] JsonView child(const nlohmann::ordered_json& value, const std::string& key) const;

  std::shared_ptr<const nlohmann::ordered_json> root_;  // keeps value_ alive
  std::shared_ptr<const std::string> file_;
  const nlohmann::ordered_json* value_ = nullptr;
  std::string pointer_;  // RFC 6901, of this value
  std::string key_;
};

}  // namespace glint

// A JSON file read with its place at hand: what is missing or of another kind ends with the file,
// the way to the value and what was expected.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace glint {

class JsonView {
 public:
  // Throws InputError with file and line where it cannot be read or is no JSON object.
  [[nodiscard]] static JsonView of_file(const std::string& path);

  [[nodiscard]] bool has(const char* key) const;
  // The value at a key; all of these throw InputError where it is not there or of another kind.
  [[nodiscard]] JsonView at(const char* key) const;
  [[nodiscard]] std::string text(const char* key) const;
  [[nodiscard]] double number(const char* key) const;
  // The items of a list, or of an object in the file's order; none where the key is absent.
  [[nodiscard]] std::vector<JsonView> list(const char* key) const;

  // The same, where a file may leave the key out.
  [[nodiscard]] std::string text_or(const char* key, const std::string& otherwise) const;
  [[nodiscard]] double number_or(const char* key, double otherwise) const;
  // Where null or nothing stands for "there is none": not a number.
  [[nodiscard]] double number_or_none(const char* key) const;

  // Of the value itself: its key in the object it was listed from, its text or number.
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

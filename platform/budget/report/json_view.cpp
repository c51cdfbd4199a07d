#include "platform/budget/report/json_view.hpp"

#include <algorithm>
#include <limits>

#include "platform/input_error.hpp"
#include "platform/read_file.hpp"

namespace glint {

using nlohmann::ordered_json;

namespace {

// Copying and writing recurse to the file's nesting depth; glint's files are less deep than this.
constexpr int k_max_depth = 32;

ordered_json parse(const std::string& text, const std::string& path) {
  return ordered_json::parse(text, [&](int depth, auto, const ordered_json&) {
    if (depth <= k_max_depth) return true;
    throw InputError(path + ": nested deeper than " + std::to_string(k_max_depth) +
                     " levels; expected a file of glint --json");
  });
}

}  // namespace

JsonView JsonView::of_file(const std::string& path) {
  const std::string content = read_file(path, k_text_bytes_max, "a JSON file of glint");
  JsonView view;
  try {
    view.root_ = std::make_shared<const ordered_json>(parse(content, path));
  } catch (const nlohmann::json::parse_error& error) {
    const auto end =
        content.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, content.size()));
    throw InputError(path + ":" + std::to_string(1 + std::count(content.begin(), end, '\n')) +
                     ": invalid JSON; expected a file of glint --json");
  } catch (const nlohmann::json::out_of_range&) {  // states no position
    throw InputError(path + ": a number out of range; expected a file of glint --json");
  }
  view.file_ = std::make_shared<const std::string>(path);
  view.value_ = view.root_.get();
  if (!view.value_->is_object()) view.refuse("", view.value_->type_name(), "an object");
  return view;
}

void JsonView::refuse(const std::string& place, const std::string& found,
                      const char* expected) const {
  throw InputError(*file_ + ": " +
                   (pointer_ + place).append(pointer_.empty() && place.empty() ? "/" : "") +
                   ": found " + found + "; expected " + expected);
}

JsonView JsonView::child(const ordered_json& value, const std::string& key) const {
  JsonView view = *this;
  view.value_ = &value;
  view.pointer_ += '/' + key;
  view.key_ = key;
  return view;
}

bool JsonView::has(const char* key) const {
  return value_->is_object() && value_->contains(key) && !(*value_)[key].is_null();
}

JsonView JsonView::at(const char* key) const {
  if (!has(key)) refuse('/' + std::string(key), "nothing", "a value");
  return child((*value_)[key], key);
}

std::string JsonView::text(const char* key) const { return at(key).as_text(); }

double JsonView::number(const char* key) const { return at(key).as_number(); }

std::string JsonView::text_or(const char* key, const std::string& otherwise) const {
  return has(key) ? text(key) : otherwise;
}

double JsonView::number_or(const char* key, double otherwise) const {
  return has(key) ? number(key) : otherwise;
}

double JsonView::number_or_none(const char* key) const {
  return number_or(key, std::numeric_limits<double>::quiet_NaN());
}

std::string JsonView::as_text() const {
  if (!value_->is_string()) refuse("", value_->dump(), "a text");
  return value_->get<std::string>();
}

double JsonView::as_number() const {
  if (!value_->is_number()) refuse("", value_->dump(), "a number");
  return value_->get<double>();
}

std::vector<JsonView> JsonView::list(const char* key) const {
  std::vector<JsonView> items;
  if (!has(key)) return items;
  const JsonView all = at(key);
  if (all.value_->is_object()) {
    for (const auto& [name, value] : all.value_->items()) items.push_back(all.child(value, name));
    return items;
  }
  if (!all.value_->is_array()) all.refuse("", all.value_->type_name(), "a list");
  for (std::size_t i = 0; i < all.value_->size(); ++i) {
    items.push_back(all.child((*all.value_)[i], std::to_string(i)));
  }
  return items;
}

}  // namespace glint

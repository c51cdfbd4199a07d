#include "platform/sinks/view/accepted_origin.hpp"

namespace glint {

bool is_accepted_origin(std::string_view origin, std::string_view addressed) {
  if (origin.empty()) return true;  // not a page
  const bool is_numbers = addressed.find_first_not_of("0123456789.:") == std::string_view::npos;
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (origin.substr(0, scheme.size()) != scheme) continue;
    const std::string_view host = origin.substr(scheme.size());
    if (is_numbers && host == addressed) return true;
    for (const std::string_view accepted :
         {"localhost", "127.0.0.1", "[::1]", "app.foxglove.dev"}) {
      if (host == accepted) return true;
      if (host.substr(0, accepted.size()) == accepted && host[accepted.size()] == ':') return true;
    }
    return false;
  }
  return origin != "null";  // a program with a scheme of its own; no page of the web can state it
}

}  // namespace glint

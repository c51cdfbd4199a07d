// Origins of pages in a browser that may connect to the live view.
#pragma once

#include <string_view>

namespace glint {

// origin: as the browser states it, empty if the client is no page. addressed: host and port to
// which the request is addressed. Accepted are pages of this machine, Foxglove's own, programs with
// a scheme of their own, and the page of this server. The last has the origin that the request is
// addressed to, as numbers: the owner of a name can make it lead to any address.
[[nodiscard]] bool is_accepted_origin(std::string_view origin, std::string_view addressed);

}  // namespace glint

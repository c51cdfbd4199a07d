// HTTP side of the live view: GET / returns the page of page/, which is compiled into the program.
//
// Any other path, method or a request with a body is refused. The page is sent in its parts, one
// each time that the connection accepts more; nothing is copied for a client beforehand.
#pragma once

#include <libwebsockets.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace glint {

// State of one HTTP connection.
struct PageReply {
  std::size_t next_part = 0;
};

// What is answered to a request: 200 for the page.
[[nodiscard]] unsigned page_status(lws* connection, std::string_view path);

// Sends the headers of the page, or the complete refusal. These return what the library's callback
// returns: 0, or -1 to disconnect.
[[nodiscard]] int begin_page(lws* connection, PageReply& reply);
[[nodiscard]] int refuse_request(lws* connection, unsigned status);
// Sends the next part. `room` follows LWS_PRE bytes and is at least k_page_part_bytes_max long.
[[nodiscard]] int send_page_part(lws* connection, PageReply& reply, std::span<std::uint8_t> room);

inline constexpr std::size_t k_page_part_bytes_max = std::size_t{16} << 10;

}  // namespace glint

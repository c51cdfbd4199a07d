#include "platform/sinks/view/page_reply.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace glint {
namespace {

using namespace std::string_view_literals;  // clang++ does not measure strings of this length

// k_page_parts and k_page_policy, of page/bundle.mjs or, in a build without npm, of no_page.inc.
#include "view_page.inc"

constexpr std::size_t page_bytes() {
  std::size_t bytes = 0;
  for (const std::string_view part : k_page_parts) bytes += part.size();
  return bytes;
}

static_assert(std::all_of(std::begin(k_page_parts), std::end(k_page_parts),
                          [](std::string_view part) {
                            return !part.empty() && part.size() <= k_page_part_bytes_max;
                          }));

// The page loads nothing from another host, runs no script but its own and is in no other page.
constexpr std::array<std::pair<const char*, std::string_view>, 6> k_page_headers = {{
    {"content-security-policy:", k_page_policy},
    {"x-content-type-options:", "nosniff"},
    {"x-frame-options:", "DENY"},
    {"referrer-policy:", "no-referrer"},
    {"cross-origin-resource-policy:", "same-origin"},
    {"cache-control:", "no-store"},
}};

constexpr std::string_view k_refusal =
    "Expected GET / without a body, or a WebSocket of protocol foxglove.websocket.v1\n";

const std::uint8_t* bytes_at(const char* text) {
  return reinterpret_cast<const std::uint8_t*>(text);
}

[[nodiscard]] bool send_headers(lws* connection, unsigned status, const char* type,
                                std::size_t bytes) {
  std::array<std::uint8_t, LWS_PRE + 2048> room{};
  std::uint8_t* const begin = room.data() + LWS_PRE;
  std::uint8_t* const end = room.data() + room.size();
  std::uint8_t* at = begin;
  if (lws_add_http_common_headers(connection, status, type, bytes, &at, end) != 0) return false;
  for (const auto& [name, value] : k_page_headers) {
    if (lws_add_http_header_by_name(connection, bytes_at(name), bytes_at(value.data()),
                                    static_cast<int>(value.size()), &at, end) != 0) {
      return false;
    }
  }
  if (status != HTTP_STATUS_OK &&
      lws_add_http_header_by_name(connection, bytes_at("connection:"), bytes_at("close"), 5, &at,
                                  end) != 0) {
    return false;
  }
  return lws_finalize_write_http_header(connection, begin, &at, end) == 0;
}

}  // namespace

unsigned page_status(lws* connection, std::string_view path) {
  if (lws_hdr_total_length(connection, WSI_TOKEN_GET_URI) <= 0) {
    return HTTP_STATUS_METHOD_NOT_ALLOWED;
  }
  if (path != "/") return HTTP_STATUS_NOT_FOUND;
  const bool has_body = lws_hdr_total_length(connection, WSI_TOKEN_HTTP_CONTENT_LENGTH) > 0 ||
                        lws_hdr_total_length(connection, WSI_TOKEN_HTTP_TRANSFER_ENCODING) > 0;
  return has_body ? HTTP_STATUS_REQ_ENTITY_TOO_LARGE : HTTP_STATUS_OK;
}

int begin_page(lws* connection, PageReply& reply) {
  if (!send_headers(connection, HTTP_STATUS_OK, k_page_type, page_bytes())) return -1;
  reply.next_part = 0;
  lws_callback_on_writable(connection);
  return 0;
}

int refuse_request(lws* connection, unsigned status) {
  std::array<std::uint8_t, LWS_PRE + k_refusal.size()> room{};
  std::copy(k_refusal.begin(), k_refusal.end(), room.begin() + LWS_PRE);
  const bool is_head = lws_hdr_total_length(connection, WSI_TOKEN_HEAD_URI) > 0;  // has no body
  if (send_headers(connection, status, "text/plain", k_refusal.size()) && !is_head) {
    (void)lws_write(connection, room.data() + LWS_PRE, k_refusal.size(), LWS_WRITE_HTTP_FINAL);
  }
  return -1;
}

int send_page_part(lws* connection, PageReply& reply, std::span<std::uint8_t> room) {
  const std::string_view part = k_page_parts[reply.next_part++];
  std::copy(part.begin(), part.end(), room.begin());
  const bool last = reply.next_part == std::size(k_page_parts);
  const int written =
      lws_write(connection, room.data(), part.size(), last ? LWS_WRITE_HTTP_FINAL : LWS_WRITE_HTTP);
  if (written < static_cast<int>(part.size())) return -1;
  if (last) return lws_http_transaction_completed(connection) != 0 ? -1 : 0;
  lws_callback_on_writable(connection);
  return 0;
}

}  // namespace glint

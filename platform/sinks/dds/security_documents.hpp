// Texts of DDS Security's governance and permissions documents (OMG DDS-Security 1.1, 9.4.1).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "platform/cells/dds_input.hpp"

namespace glint {

// Names of the run's identity; no peer has them.
inline constexpr const char* k_run_identity = "glint";

// Another participant. Every peer may receive what Glint publishes.
struct PeerRights {
  std::string name;                 // letters, digits, '_'
  std::vector<DdsInput> inputs;     // that it may send
  std::vector<std::string> topics;  // DDS topics that it may send as well
};

struct Validity {
  std::int64_t from_s = 0, to_s = 0;  // Unix time
};

struct SecurityScope {
  int first_domain = 0, last_domain = 0;  // of all domains that the run joins
  std::string name;                       // namespace of the run; empty: none
  Validity validity;
};

// Only authenticated participants join; discovery, contents and their metadata are encrypted.
[[nodiscard]] std::string governance_text(const SecurityScope& scope);

// Rights of one identity; all that is not listed is denied.
[[nodiscard]] std::string run_permissions_text(const SecurityScope& scope);
[[nodiscard]] std::string peer_permissions_text(const PeerRights& peer, const SecurityScope& scope);

// Distinguished name of an identity, in certificate and permissions: the CN is ROS 2's enclave.
[[nodiscard]] std::string common_name(const std::string& identity);

}  // namespace glint

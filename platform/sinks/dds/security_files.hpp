// DDS Security of a participant: the folder with its keys and documents, and Cyclone's plug-ins.
#pragma once

#include <array>
#include <string>

namespace glint {

// A file of the folder, as ROS 2 names it in an enclave (rmw_dds_common, security.cpp), and
// Cyclone's setting for it.
struct SecurityFile {
  const char* name;
  const char* setting;
};
inline constexpr SecurityFile k_identity_ca{"identity_ca.cert.pem", "IdentityCA"};
inline constexpr SecurityFile k_certificate{"cert.pem", "IdentityCertificate"};
inline constexpr SecurityFile k_private_key{"key.pem", "PrivateKey"};
inline constexpr SecurityFile k_permissions_ca{"permissions_ca.cert.pem", "PermissionsCA"};
inline constexpr SecurityFile k_governance{"governance.p7s", "Governance"};
inline constexpr SecurityFile k_permissions{"permissions.p7s", "Permissions"};

// Throws InputError for a file that is missing, empty or unreadable; MissingDevice if the plug-ins
// are not installed. An empty folder's name means no security.
void require_security(const std::string& folder);

// Cyclone's setting <Security>; "" without a folder. The folder's name has no XML markup.
[[nodiscard]] std::string security_configuration(const std::string& folder);

}  // namespace glint

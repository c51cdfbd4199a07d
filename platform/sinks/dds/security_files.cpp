#include "platform/sinks/dds/security_files.hpp"

#include <dds/dds.h>
#include <dlfcn.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "platform/input_error.hpp"

namespace glint {
namespace {

constexpr std::array<SecurityFile, 3> k_authentication_files{k_identity_ca, k_certificate,
                                                             k_private_key};
constexpr std::array<SecurityFile, 3> k_access_files{k_permissions_ca, k_governance, k_permissions};

struct PlugIn {
  const char* section;
  const char* library;
  const char* function;  // init_FUNCTION, finalize_FUNCTION
};
constexpr PlugIn k_authentication{"Authentication", "libdds_security_auth.so", "authentication"};
constexpr PlugIn k_access{"AccessControl", "libdds_security_ac.so", "access_control"};
constexpr PlugIn k_cryptography{"Cryptographic", "libdds_security_crypto.so", "crypto"};

// Debian's folder of the plug-ins is beside Cyclone's library and outside of the linker's path.
std::string path_of(const PlugIn& plug_in) {
  Dl_info library{};
  if (dladdr(reinterpret_cast<const void*>(&dds_create_participant), &library) == 0) return "";
  const std::filesystem::path folder = std::filesystem::path(library.dli_fname).parent_path();
  return (folder / "libddsc0debian" / plug_in.library).string();
}

void require_file(const std::string& folder, const char* name) {
  const std::string path = folder + "/" + name;
  errno = 0;
  std::ifstream file(path);
  const bool opened = file.is_open();
  if (opened && file.peek() != std::ifstream::traits_type::eof()) return;
  const std::string reason = errno != 0 ? std::generic_category().message(errno) : "is empty";
  throw InputError("dds.security: " + path + ": " + reason +
                   "; expected a folder of `glint dds keys`");
}

template <std::size_t N>
std::string section(const PlugIn& plug_in, const std::array<SecurityFile, N>& files,
                    const std::string& folder) {
  const std::string name = plug_in.section, function = plug_in.function;
  std::string text = "<" + name + "><Library path=\"" + path_of(plug_in) +
                     "\" initFunction=\"init_" + function + "\" finalizeFunction=\"finalize_" +
                     function + "\"/>";
  for (const SecurityFile& file : files) {
    const std::string setting = file.setting;
    text += "<" + setting + ">file:" + std::filesystem::absolute(folder).string() + "/" +
            file.name + "</" + setting + ">";
  }
  return text + "</" + name + ">";
}

}  // namespace

void require_security(const std::string& folder) {
  if (folder.empty()) return;
  for (const SecurityFile& file : k_authentication_files) require_file(folder, file.name);
  for (const SecurityFile& file : k_access_files) require_file(folder, file.name);
  for (const PlugIn& plug_in : {k_authentication, k_access, k_cryptography}) {
    const std::string path = path_of(plug_in);
    if (std::filesystem::exists(path)) continue;
    throw MissingDevice("dds.security: no plug-in " + path +
                        "; expected Cyclone DDS with its security plug-ins");
  }
}

std::string security_configuration(const std::string& folder) {
  if (folder.empty()) return "";
  return "<Security>" + section(k_authentication, k_authentication_files, folder) +
         section(k_access, k_access_files, folder) + section<0>(k_cryptography, {}, folder) +
         "</Security>";
}

}  // namespace glint

#include "platform/sinks/dds/network.hpp"

#include <ifaddrs.h>
#include <net/if.h>

#include <memory>
#include <set>

#include "platform/input_error.hpp"
#include "platform/sinks/dds/security_files.hpp"

namespace glint {
namespace {

// Maximum number of participants on one machine without multicast. Cyclone's default of 9 rejected
// the tenth of 16 processes.
constexpr const char* k_participant_index_max = "60";

struct FreeAddresses {
  void operator()(ifaddrs* list) const { freeifaddrs(list); }
};
using Addresses = std::unique_ptr<ifaddrs, FreeAddresses>;

Addresses all_addresses() {
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) list = nullptr;
  return Addresses(list);
}

bool usable(const ifaddrs& entry) {
  return entry.ifa_addr != nullptr && entry.ifa_addr->sa_family == AF_INET &&
         (entry.ifa_flags & IFF_UP) != 0;
}

bool is_loopback(const std::string& name) {
  const Addresses list = all_addresses();
  for (const ifaddrs* entry = list.get(); entry != nullptr; entry = entry->ifa_next) {
    if (name == entry->ifa_name) return (entry->ifa_flags & IFF_LOOPBACK) != 0;
  }
  return false;
}

// Rejects names with XML markup; no interface or host has such a name.
std::string plain(const std::string& text) {
  if (text.find_first_of("<>&\"'") != std::string::npos) {
    throw InputError("dds: found '" + text + "'; expected a host, interface or folder name");
  }
  return text;
}

}  // namespace

void require_network_interface(const std::string& name) {
  const Addresses list = all_addresses();
  std::set<std::string> names;
  for (const ifaddrs* entry = list.get(); entry != nullptr; entry = entry->ifa_next) {
    if (usable(*entry)) names.insert(entry->ifa_name);
  }
  if (names.contains(name)) return;
  std::string known;
  for (const std::string& one : names) known += (known.empty() ? "" : ", ") + one;
  throw MissingDevice("dds.interface: no network interface \"" + name +
                      "\" that is up with an IPv4 address; expected one of: " +
                      (known.empty() ? "none is up" : known));
}

std::string cyclone_configuration(const DdsSettings& settings) {
  const bool loopback = is_loopback(settings.interface);
  std::string peers;
  if (loopback) peers += "<Peer address=\"127.0.0.1\"/>";
  for (const std::string& peer : settings.peers) {
    peers += "<Peer address=\"" + plain(peer) + "\"/>";
  }
  const std::string multicast = loopback ? "false" : "true";
  return "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"" +
         plain(settings.interface) + "\" multicast=\"" + multicast +
         "\"/></Interfaces><AllowMulticast>" + multicast +
         "</AllowMulticast></General><Discovery><ParticipantIndex>auto</ParticipantIndex>"
         "<MaxAutoParticipantIndex>" +
         k_participant_index_max + "</MaxAutoParticipantIndex>" +
         (peers.empty() ? "" : "<Peers>" + peers + "</Peers>") +
         "</Discovery><Internal><MaxSampleSize>" + std::to_string(k_message_bytes_max) +
         "B</MaxSampleSize></Internal>" + security_configuration(plain(settings.security)) +
         "<Tracing><Verbosity>severe</Verbosity></Tracing></Domain></"
         "CycloneDDS>";
}

}  // namespace glint

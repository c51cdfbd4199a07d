// Keys, certificates and signed documents of DDS Security for a run and its peers, in the folders
// of a ROS 2 keystore (sros2):
//   private/ca.key.pem, public/ca.cert.pem   the authority; its key stays where keys are made
//   enclaves/glint/, enclaves/PEER/          all that one participant needs
#pragma once

#include <string>
#include <vector>

#include "platform/sinks/dds/security_documents.hpp"

namespace glint {

struct KeySettings {
  std::string folder;
  SecurityScope scope;
  std::vector<PeerRights> peers;
};

// Keys and an authority that exist are kept; certificates and documents are written again. Thus a
// peer is added, its rights are changed and its validity is extended by another call. Returns the
// folders of the run and of each peer. Throws InputError: names, a file that cannot be read or
// written.
std::vector<std::string> write_security_keys(const KeySettings& settings);

}  // namespace glint

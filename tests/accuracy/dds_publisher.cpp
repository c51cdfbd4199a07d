// Publishes messages from standard input unchanged: a script without DDS sends the bytes of a ROS 2
// driver. It uses Cyclone DDS and the types only, with a configuration of its own.
//
//   dds_publisher DOMAIN TYPE:QUALITY:TOPIC...
//
// TYPE: image, info, pose, tf. QUALITY: reliable, best_effort, latched. TOPIC: the DDS name. A
// record of the input is two 32-bit numbers in native byte order, the topic's index and the number
// of bytes, and the message with its encapsulation. A record of 0 bytes waits until the topic has a
// reader and then prints a line. The end of the input ends the publisher.
#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include "geometry_msgs.h"
#include "sensor_msgs.h"
#include "tf2_msgs.h"

namespace {

const std::map<std::string, const dds_topic_descriptor_t*> k_types = {
    {"image", &sensor_msgs_msg_dds__Image__desc},
    {"info", &sensor_msgs_msg_dds__CameraInfo__desc},
    {"pose", &geometry_msgs_msg_dds__PoseStamped__desc},
    {"tf", &tf2_msgs_msg_dds__TFMessage__desc}};

struct Output {
  dds_entity_t writer;
  const ddsi_sertype* type;
};

const dds_topic_descriptor_t* descriptor_of(const std::string& argument) {
  return k_types.at(argument.substr(0, argument.find(':')));
}

dds_entity_t writer_of(dds_entity_t participant, const std::string& argument) {
  const std::size_t first = argument.find(':'), second = argument.find(':', first + 1);
  const std::string quality = argument.substr(first + 1, second - first - 1);
  dds_qos_t* const qos = dds_create_qos();
  dds_qset_reliability(
      qos, quality == "best_effort" ? DDS_RELIABILITY_BEST_EFFORT : DDS_RELIABILITY_RELIABLE,
      DDS_MSECS(100));
  if (quality == "latched") dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, quality == "best_effort" ? 5 : 50);
  const dds_data_representation_id_t xcdr1 = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_data_representation(qos, 1, &xcdr1);
  const dds_entity_t topic = dds_create_topic(
      participant, descriptor_of(argument), argument.substr(second + 1).c_str(), nullptr, nullptr);
  const dds_entity_t writer = dds_create_writer(participant, topic, qos, nullptr);
  dds_delete_qos(qos);
  return writer;
}

bool has_reader(dds_entity_t writer) {
  dds_publication_matched_status_t status{};
  dds_get_publication_matched_status(writer, &status);
  return status.current_count > 0;
}

// Cyclone's type object, which only messages of its own contain: read from an empty message on a
// private topic.
const ddsi_sertype* type_of(dds_entity_t participant, const dds_topic_descriptor_t* descriptor) {
  const std::string name = std::string("own_") + std::to_string(descriptor->m_size);
  const dds_entity_t topic =
      dds_create_topic(participant, descriptor, name.c_str(), nullptr, nullptr);
  const dds_entity_t reader = dds_create_reader(participant, topic, nullptr, nullptr);
  const dds_entity_t writer = dds_create_writer(participant, topic, nullptr, nullptr);
  const std::vector<char> empty(descriptor->m_size);
  ddsi_serdata* data = nullptr;
  dds_sample_info_t info;
  if (dds_write(writer, empty.data()) != DDS_RETCODE_OK ||
      dds_takecdr(reader, &data, 1, &info, DDS_ANY_STATE) != 1) {
    std::fprintf(stderr, "no message of %s\n", descriptor->m_typename);
    std::exit(1);
  }
  return data->type;  // owned by the message, which is never freed
}

bool write(const Output& output, const std::vector<char>& bytes) {
  ddsrt_iovec_t part{};
  part.iov_base = const_cast<char*>(bytes.data());
  part.iov_len = static_cast<ddsrt_iov_len_t>(bytes.size());
  ddsi_serdata* const data =
      ddsi_serdata_from_ser_iov(output.type, SDK_DATA, 1, &part, bytes.size());
  return data != nullptr && dds_writecdr(output.writer, data) == DDS_RETCODE_OK;
}

}  // namespace

int main(int count, char** arguments) {
  if (count < 3) {
    std::fprintf(stderr, "usage: %s DOMAIN TYPE:QUALITY:TOPIC...\n", arguments[0]);
    return 2;
  }
  const auto domain = static_cast<dds_domainid_t>(std::atoi(arguments[1]));
  const dds_entity_t participant = dds_create_participant(domain, nullptr, nullptr);
  std::vector<Output> outputs;
  for (int i = 2; i < count; ++i) {
    outputs.push_back(
        {writer_of(participant, arguments[i]), type_of(participant, descriptor_of(arguments[i]))});
  }
  std::vector<char> bytes;
  for (std::uint32_t head[2]; std::fread(head, sizeof head, 1, stdin) == 1;) {
    const Output& output = outputs.at(head[0]);
    bytes.resize(head[1]);
    if (bytes.empty()) {
      while (!has_reader(output.writer)) dds_sleepfor(DDS_MSECS(5));
      std::printf("topic %u has a reader\n", head[0]);
      std::fflush(stdout);
    } else if (std::fread(bytes.data(), bytes.size(), 1, stdin) != 1 || !write(output, bytes)) {
      std::fprintf(stderr, "topic %u: a message of %u bytes was not written\n", head[0], head[1]);
      return 1;
    }
  }
  for (const Output& output : outputs) (void)dds_wait_for_acks(output.writer, DDS_SECS(5));
  dds_delete(participant);
  return 0;
}

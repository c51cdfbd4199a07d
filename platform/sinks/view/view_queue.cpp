#include "platform/sinks/view/view_queue.hpp"

#include <algorithm>

namespace glint {

ViewQueue::Channel* ViewQueue::find(std::uint32_t number) {
  const auto found = std::find_if(channels_.begin(), channels_.end(),
                                  [&](const Channel& one) { return one.number == number; });
  return found == channels_.end() ? nullptr : &*found;
}

void ViewQueue::add_channel(std::uint16_t channel, std::string_view topic, std::string_view type,
                            std::string_view schema) {
  const std::lock_guard lock(mutex_);
  channels_.push_back({channel_json(channel, topic, type, schema), channel, 0, nullptr});
}

bool ViewQueue::add_message(std::uint16_t channel, std::uint64_t unix_ns,
                            std::span<const std::uint8_t> cdr) {
  const std::lock_guard lock(mutex_);
  Channel* const found = find(channel);
  if (found == nullptr) return false;
  const bool keeps = cdr.size() <= k_newest_bytes_max, sends = found->subscribers > 0;
  if (!keeps && !sends) return false;
  auto message = std::make_shared<ViewMessage>();
  message->channel = channel;
  message->unix_ns = unix_ns;
  message->cdr.assign(cdr.begin(), cdr.end());
  if (sends) message->number = next_number_++;
  if (keeps) found->newest = message;
  if (!sends) return false;
  bytes_ += message->cdr.size();
  queue_.push_back(std::move(message));
  while (bytes_ > bytes_max_ && queue_.size() > 1) {
    bytes_ -= queue_.front()->cdr.size();
    queue_.pop_front();
  }
  return true;
}

void ViewQueue::enter(ViewClient& client) {
  client.waiting.push_back({text_bytes(server_info()), nullptr, 0});
  const std::lock_guard lock(mutex_);
  ++counts_.clients;
  client.next = next_number_;
}

void ViewQueue::leave(ViewClient& client) {
  const std::lock_guard lock(mutex_);
  (void)skip_dropped(client);
  for (const Subscription& one : client.subscriptions) --channels_[one.channel_index].subscribers;
  client.subscriptions.clear();
}

void ViewQueue::refuse() {
  const std::lock_guard lock(mutex_);
  ++counts_.refused;
}

// Requires the lock.
void ViewQueue::reject(ViewClient& client, const std::string& why) {
  ++counts_.invalid;
  client.waiting.push_back({text_bytes(error_status(why)), nullptr, 0});
}

// Requires the lock.
void ViewQueue::subscribe(ViewClient& client, const RequestedChannel& wanted) {
  Channel* const channel = find(wanted.channel);
  if (channel == nullptr) return reject(client, "no channel " + std::to_string(wanted.channel));
  if (client.subscriptions.size() == k_subscriptions_max) {
    return reject(client,
                  "expected at most " + std::to_string(k_subscriptions_max) + " subscriptions");
  }
  const auto index = static_cast<std::size_t>(channel - channels_.data());
  if (!client.subscriptions.insert({wanted.id, index}).second) {
    return reject(client, "subscription " + std::to_string(wanted.id) + " exists");
  }
  ++channel->subscribers;
  // A newest message that the queue still holds for this client comes in its turn.
  if (channel->newest == nullptr || channel->newest->number >= client.next) return;
  client.waiting.push_back({message_head(wanted.id, channel->newest->unix_ns), channel->newest, 0});
  ++counts_.messages;
}

void ViewQueue::apply(ViewClient& client, std::string_view text) {
  const std::optional<Request> request = request_of(text);
  const std::lock_guard lock(mutex_);
  if (!request) return reject(client, "expected subscribe or unsubscribe");
  for (const std::uint32_t id : request->ended) {
    const auto found = client.subscriptions.find({id, 0});  // ordered by id alone
    if (found == client.subscriptions.end()) continue;
    --channels_[found->channel_index].subscribers;
    client.subscriptions.erase(found);
  }
  for (const RequestedChannel& wanted : request->begun) subscribe(client, wanted);
}

// Counts what left the queue before the client's turn. Returns the number of the queue's first
// message. Requires the lock.
std::uint64_t ViewQueue::skip_dropped(ViewClient& client) {
  const std::uint64_t first = queue_.empty() ? next_number_ : queue_.front()->number;
  if (client.next >= first) return first;
  if (!client.subscriptions.empty()) counts_.dropped += first - client.next;
  client.next = first;
  return first;
}

void ViewQueue::enqueue_next(ViewClient& client) {
  const std::lock_guard lock(mutex_);
  if (client.advertised < channels_.size()) {
    std::vector<std::string> added;
    for (; client.advertised < channels_.size(); ++client.advertised) {
      added.push_back(channels_[client.advertised].advertisement);
    }
    client.waiting.push_back({text_bytes(advertise(added)), nullptr, 0});
    return;
  }
  const std::uint64_t first = skip_dropped(client);
  for (; client.waiting.empty() && client.next < next_number_; ++client.next) {
    const auto& message = queue_[static_cast<std::size_t>(client.next - first)];
    for (const Subscription& one : client.subscriptions) {
      if (channels_[one.channel_index].number != message->channel) continue;
      client.waiting.push_back({message_head(one.id, message->unix_ns), message, 0});
      ++counts_.messages;
    }
  }
}

bool ViewQueue::is_at_end(const ViewClient& client) const {
  const std::lock_guard lock(mutex_);
  return client.waiting.empty() && client.next == next_number_;
}

FoxgloveCounts ViewQueue::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

}  // namespace glint

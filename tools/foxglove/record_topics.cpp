// SPDX-License-Identifier: BSD-3-Clause
#include "tools/foxglove/record_topics.hpp"

#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstdio>
#include <memory>
#include <mutex>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "core/errors.hpp"
#include "core/version.hpp"
#include "run/mcap/lazy_channel.hpp"
#include "run/mcap/mcap_writer.hpp"
#include "tools/foxglove/topic_tap.hpp"

namespace isobar::tools {

namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kFlushEvery = std::chrono::seconds(1);
constexpr auto kPatience = std::chrono::seconds(10);

// Memory that messages may take while the disk is slow; beyond it the newest are left out and counted.
constexpr std::size_t kMostWaitingBytes = 256U << 20U;

volatile std::sig_atomic_t g_stop_recording = 0;

struct Message {
  std::uint32_t channel;
  std::shared_ptr<const foxglove::Data> data;
};

/// Messages on their way from the thread that takes them to the one that writes.
class Pipe {
 public:
  void put(std::uint32_t channel, std::shared_ptr<const foxglove::Data> data) {
    const std::lock_guard lock(mutex_);
    if (bytes_ + data->cdr.size() > kMostWaitingBytes) {
      ++left_out_;
      return;
    }
    bytes_ += data->cdr.size();
    waiting_.push_back({channel, std::move(data)});
  }
  void turn() { arrived_.notify_one(); }

  std::vector<Message> take(Clock::duration longest) {
    std::unique_lock lock(mutex_);
    arrived_.wait_for(lock, longest);
    bytes_ = 0;
    return std::exchange(waiting_, {});
  }
  [[nodiscard]] std::uint64_t left_out() const { return left_out_; }

 private:
  std::mutex mutex_;
  std::condition_variable arrived_;
  std::vector<Message> waiting_;
  std::size_t bytes_ = 0;
  std::uint64_t left_out_ = 0;  ///< read after the other thread has ended
};

/// Where messages of the tap's channels go.
class Writer {
 public:
  Writer(const std::filesystem::path& file, const std::vector<foxglove::Channel>& channels)
      : out_(file, version_line("isobar")) {
    for (const foxglove::Channel& channel : channels)
      channels_.emplace_back(out_, channel.topic, channel.ros_type);
  }

  void write(const Message& message) {
    channels_.at(message.channel - 1).write(message.data->stamp_ns, message.data->cdr);
  }
  void flush() { out_.flush(); }
  void close() { out_.close(); }
  void abandon() { out_.abandon(); }
  [[nodiscard]] std::uint64_t messages() const { return out_.messages(); }
  [[nodiscard]] std::uint64_t bytes() const { return out_.bytes(); }

 private:
  mcap::McapWriter out_;
  std::vector<mcap::LazyChannel> channels_;
};

bool has_room(const TopicRecording& wanted) {
  std::error_code error;
  const auto folder = std::filesystem::absolute(wanted.file).parent_path();
  const std::filesystem::space_info space = std::filesystem::space(folder, error);
  return error || static_cast<double>(space.available) >= wanted.min_free_bytes;
}

/// @return why the recording ended by itself; empty: as it was asked to
std::string record_until_end(const TopicRecording& wanted, Pipe& pipe, Writer& out) {
  const Clock::time_point start = Clock::now();
  Clock::time_point flushed = start;
  while (g_stop_recording == 0) {
    for (const Message& message : pipe.take(std::chrono::milliseconds(200))) out.write(message);
    const Clock::time_point now = Clock::now();
    if (wanted.duration_s > 0.0 && now - start >= std::chrono::duration<double>(wanted.duration_s)) break;
    if (out.messages() == 0 && now - start > kPatience)
      throw ServiceError("no message for 10 s on DDS domain " + std::to_string(wanted.dds.domain) +
                         "; is isobar-dds running?");
    if (now - flushed < kFlushEvery) continue;
    flushed = now;
    out.flush();
    if (!has_room(wanted)) return "the disk has too little room (--min-free)";
  }
  return {};
}

}  // namespace

void record_topics(const TopicRecording& wanted) {
  const dds::Participant participant = join_dds(wanted.dds);
  foxglove::TopicTap tap(participant, wanted.dds.ros_namespace);
  Writer out(wanted.file, tap.channels());
  Pipe pipe;
  std::signal(SIGINT, [](int) { g_stop_recording = 1; });
  std::signal(SIGTERM, [](int) { g_stop_recording = 1; });
  tap.start([&](std::uint32_t channel,
                std::shared_ptr<const foxglove::Data> data) { pipe.put(channel, std::move(data)); },
            [&] { pipe.turn(); });
  std::string why_ended;
  try {
    why_ended = record_until_end(wanted, pipe, out);
  } catch (const ServiceError&) {
    if (out.messages() == 0) out.abandon();
    throw;
  }
  tap.stop();
  for (const Message& message : pipe.take({})) out.write(message);
  out.close();
  std::printf("written: %s: %llu messages, %.1f MB\n", wanted.file.c_str(),
              static_cast<unsigned long long>(out.messages()), 1e-6 * static_cast<double>(out.bytes()));
  if (pipe.left_out() > 0)
    std::printf("note: %llu messages were left out while the disk was slow\n",
                static_cast<unsigned long long>(pipe.left_out()));
  if (!why_ended.empty()) throw ServiceError(why_ended);
}

}  // namespace isobar::tools

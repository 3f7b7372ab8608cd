// SPDX-License-Identifier: BSD-3-Clause
// `isobar echo`: prints received DDS messages, one readable line each.
#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "core/errors.hpp"
#include "ipc/dds/endpoints.hpp"
#include "ipc/dds/library_log.hpp"
#include "tools/commands.hpp"
#include "tools/dds_options.hpp"
#include "tools/echo_lines.hpp"
#include "tools/number_option.hpp"
#include "tools/typed_words.hpp"

namespace isobar::tools {
namespace {

using Clock = std::chrono::steady_clock;

struct EchoOptions {
  std::vector<std::string> topics{"pose"};
  DdsOptions dds;
  double rate_hz = 1.0;
  long count = 0;
  double timeout_s = 10.0;
};

volatile std::sig_atomic_t g_stop = 0;

/// Prints the first lines of Cyclone DDS's log: when an address is lost it writes one for each message.
void print_library_line(bool /*is_error*/, std::string_view line) noexcept {
  constexpr int kMostLines = 5;
  static std::atomic<int> lines{0};
  if (lines++ >= kMostLines) return;
  std::fprintf(stderr, "isobar: Cyclone DDS: %.*s\n", static_cast<int>(line.size()), line.data());
}

/// Subscriber of one topic that prints its messages.
class Echo {
 public:
  virtual ~Echo() = default;
  Echo() = default;
  Echo(const Echo&) = delete;
  Echo& operator=(const Echo&) = delete;
  [[nodiscard]] virtual dds_entity_t reader() const = 0;
  struct Taken {
    int received = 0;
    int printed = 0;
    bool waits = false;  ///< a message is there, to be printed later
  };
  /// Takes all waiting messages and prints as many as the rate allows.
  virtual Taken take(Clock::time_point now) = 0;
};

template <class Message>
class TopicEcho : public Echo {
 public:
  TopicEcho(dds_entity_t participant, const dds::DdsTopic<Message>& topic, const EchoOptions& options)
      : name_(topic.name),
        period_(std::chrono::duration_cast<Clock::duration>(
            std::chrono::duration<double>(1.0 / options.rate_hz))),
        is_latched_(topic.delivery == dds::Delivery::kLatched),
        reader_(participant, topic, options.dds.ros_namespace) {}

  [[nodiscard]] dds_entity_t reader() const override { return reader_.get(); }

  // A latched topic says how things are until it says otherwise: its newest message stays with the reader until its time has
  // come.
  Taken take(Clock::time_point now) override {
    Taken taken;
    if (is_latched_ && now < next_) {
      std::uint32_t waiting = 0;
      dds_get_status_changes(reader_.get(), &waiting);
      taken.waits = (waiting & DDS_DATA_AVAILABLE_STATUS) != 0;
      return taken;
    }
    taken.received = reader_.take([&](const Message& message) {
      if (now < next_) {
        return;
      }
      next_ = now + period_;
      print_line(name_, message);
      std::fflush(stdout);
      ++taken.printed;
    });
    return taken;
  }

 private:
  const char* name_;
  Clock::duration period_;
  bool is_latched_;
  Clock::time_point next_{};
  dds::Reader<Message> reader_;
};

/// Calls with every topic that isobar-dds writes or reads.
template <class Call>
void for_each_topic(Call call) {
  using namespace dds::topics;
  const auto each = [&](const auto&... topics) { (call(topics), ...); };
  each(kPose, kOdom, kAltitude, kTf, kTfStatic, kRegisteredScan, kMapCloud, kMap, kFloor, kFloorName,
       kDiagnostics, kPressure, kBaseTemperature, kPoints, kImu, kWheel, kWheelTwist, kInitialPose);
}

std::vector<std::string> topic_names() {
  std::vector<std::string> names;
  for_each_topic([&](const auto& topic) { names.emplace_back(topic.name); });
  return names;
}

std::vector<std::unique_ptr<Echo>> make_echoes(dds_entity_t participant, const EchoOptions& options) {
  std::vector<std::unique_ptr<Echo>> echoes;
  for (const std::string& wanted : options.topics) {
    for_each_topic([&]<class Message>(const dds::DdsTopic<Message>& topic) {
      if (wanted == topic.name)
        echoes.push_back(std::make_unique<TopicEcho<Message>>(participant, topic, options));
    });
  }
  return echoes;
}

void run(const EchoOptions& options) {
  dds::set_library_log(&print_library_line);
  const dds::Participant participant = join_dds(options.dds);
  const std::vector<std::unique_ptr<Echo>> echoes = make_echoes(participant.get(), options);
  const dds::Entity waitset = dds::checked(dds_create_waitset(participant.get()), "wait set");
  for (const std::unique_ptr<Echo>& echo : echoes) {
    dds_set_status_mask(echo->reader(), DDS_DATA_AVAILABLE_STATUS);
    dds_waitset_attach(waitset.get(), echo->reader(), 0);
  }
  std::signal(SIGINT, [](int) { g_stop = 1; });
  std::signal(SIGTERM, [](int) { g_stop = 1; });
  const auto patience = std::chrono::duration<double>(options.timeout_s);
  Clock::time_point last = Clock::now();
  for (long printed = 0; g_stop == 0 && (options.count == 0 || printed < options.count);) {
    // With a timeout, because a signal does not end the wait.
    dds_waitset_wait(waitset.get(), nullptr, 0, DDS_MSECS(100));
    const Clock::time_point now = Clock::now();
    bool waits = false;
    for (const std::unique_ptr<Echo>& echo : echoes) {
      const Echo::Taken taken = echo->take(now);
      last = taken.received > 0 || taken.waits ? now : last;
      printed += taken.printed;
      waits = waits || taken.waits;
    }
    // What is not taken ends the wait for messages at once.
    if (waits) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    if (options.timeout_s > 0.0 && now - last > patience) {
      throw ServiceError("no message for " + std::to_string(std::lround(options.timeout_s)) +
                         " s on DDS domain " + std::to_string(options.dds.domain) +
                         "; is isobar-dds running?");
    }
  }
}

}  // namespace

void add_echo_command(CLI::App& app) {
  auto options = std::make_shared<EchoOptions>();
  CLI::App* command = app.add_subcommand("echo", "Print received DDS messages, one line each");
  command
      ->add_option(
          "TOPIC", options->topics,
          "topics that isobar-dds writes or reads; a base station's fluid_pressure and temperature with "
          "--namespace base; renamed ones (dds.topics) are not found")
      ->check(one_of(topic_names()))
      ->capture_default_str();
  add_dds_options(*command, options->dds);
  command->add_option("--rate", options->rate_hz, "highest rate of lines per topic [Hz]")
      ->check(number_within(1e-3, 1e6))
      ->capture_default_str();
  command->add_option("--count", options->count, "stop after this number of lines; 0: never")
      ->check(number_from_zero())
      ->capture_default_str();
  command->add_option("--timeout", options->timeout_s, "fail after this time without a message [s]; 0: never")
      ->check(number_within(0.0, 1e6))
      ->capture_default_str();
  command->callback([options] { run(*options); });
}

}  // namespace isobar::tools

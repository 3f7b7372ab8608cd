// SPDX-License-Identifier: BSD-3-Clause
// `isobar echo`: prints received DDS messages, one readable line each.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "core/errors.hpp"
#include "core/geometry.hpp"
#include "ipc/dds/endpoints.hpp"
#include "ipc/dds/library_log.hpp"
#include "ipc/dds/messages.hpp"
#include "tools/commands.hpp"
#include "tools/number_option.hpp"
#include "tools/typed_words.hpp"

namespace isobar::tools {
namespace {

using Clock = std::chrono::steady_clock;

struct EchoOptions {
  std::vector<std::string> topics{"pose"};
  int domain = 0;
  std::string network_interface;
  std::string ros_namespace;
  double rate_hz = 1.0;
  long count = 0;
  double timeout_s = 10.0;
};

volatile std::sig_atomic_t g_stop = 0;

double seconds(const dds::HeaderMessage& header) {
  return static_cast<double>(header.stamp.sec) + 1e-9 * static_cast<double>(header.stamp.nanosec);
}

/// Rotation about z of a gravity-aligned frame [degrees].
double yaw_deg(const geometry_msgs_msg_dds__Quaternion_& q) {
  return std::atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z)) / kRadPerDeg;
}

/// Prints the first lines of Cyclone DDS's log: when an address is lost it writes one for each message.
void print_library_line(bool /*is_error*/, std::string_view line) noexcept {
  constexpr int kMostLines = 5;
  static std::atomic<int> lines{0};
  if (lines++ >= kMostLines) return;
  std::fprintf(stderr, "isobar: Cyclone DDS: %.*s\n", static_cast<int>(line.size()), line.data());
}

/// A text of a received message; empty when the sender left it null.
const char* shown(const char* value) { return value != nullptr ? value : ""; }

void print(const char* topic, const dds::PoseMessage& message) {
  const auto& [position, orientation] = message.pose.pose;
  std::printf("%s  t %.3f s  x %8.3f  y %8.3f  z %7.3f m (+-%.3f)  yaw %7.2f deg\n", topic,
              seconds(message.header), position.x, position.y, position.z,
              std::sqrt(std::max(0.0, message.pose.covariance[14])), yaw_deg(orientation));
}

void print(const char* topic, const dds::OdometryMessage& message) {
  const auto& [position, orientation] = message.pose.pose;
  std::printf("%s  t %.3f s  x %8.3f  y %8.3f  z %7.3f m  yaw %7.2f deg  v %6.3f m/s  w %7.4f rad/s\n", topic,
              seconds(message.header), position.x, position.y, position.z, yaw_deg(orientation),
              message.twist.twist.linear.x, message.twist.twist.angular.z);
}

void print(const char* topic, const dds::AltitudeMessage& message) {
  std::printf("%s  t %.3f s  height %7.3f m (+-%.3f)  %s", topic, seconds(message.header), message.height,
              std::sqrt(std::max(0.0, message.variance)), shown(message.source));
  if (!std::isnan(message.bias)) {
    std::printf("  bias %6.3f m (+-%.3f)  innovation %6.3f m  airflow %.1f mm per (m/s)^2 (+-%.1f)%s",
                message.bias, std::sqrt(message.bias_variance), message.innovation, 1e3 * message.airflow,
                1e3 * std::sqrt(message.airflow_variance), message.faulty ? "  faulty" : "");
  }
  if (std::string_view(shown(message.drifting)) != "none")
    std::printf("  drifting: %s", shown(message.drifting));
  std::printf("\n");
}

void print(const char* topic, const dds::TfMessage& message) {
  for (std::uint32_t i = 0; i < message.transforms._length; ++i) {
    const auto& [header, child, transform] = message.transforms._buffer[i];
    std::printf("%s  t %.3f s  %s -> %s  x %8.3f  y %8.3f  z %7.3f m  yaw %7.2f deg\n", topic,
                seconds(header), shown(header.frame_id), shown(child), transform.translation.x,
                transform.translation.y, transform.translation.z, yaw_deg(transform.rotation));
  }
}

void print(const char* topic, const dds::GridMessage& message) {
  const auto& info = message.info;
  const std::span<const std::uint8_t> cells(message.data._buffer, message.data._length);
  const auto known = std::count_if(cells.begin(), cells.end(), [](std::uint8_t cell) { return cell <= 100; });
  std::printf("%s  t %.3f s  %u x %u cells of %.3f m  from x %.3f  y %.3f  z %.3f m  %ld known\n", topic,
              seconds(message.header), info.width, info.height, static_cast<double>(info.resolution),
              info.origin.position.x, info.origin.position.y, info.origin.position.z,
              static_cast<long>(known));
}

void print(const char* topic, const dds::CloudMessage& message) {
  std::printf("%s  t %.3f s  %u points of %u bytes in %s  ", topic, seconds(message.header),
              message.width * message.height, message.point_step, shown(message.header.frame_id));
  for (std::uint32_t i = 0; i < message.fields._length; ++i)
    std::printf("%s%s", i == 0 ? "" : ", ", shown(message.fields._buffer[i].name));
  std::printf("\n");
}

void print(const char* topic, const dds::PressureMessage& message) {
  std::printf("%s  t %.3f s  %.2f Pa (+-%.2f)  %s\n", topic, seconds(message.header), message.fluid_pressure,
              std::sqrt(std::max(0.0, message.variance)), shown(message.header.frame_id));
}

void print(const char* topic, const dds::Int32Message& message) {
  std::printf("%s  %d\n", topic, message.data);
}

void print(const char* topic, const dds::StringMessage& message) {
  std::printf("%s  %s\n", topic, shown(message.data));
}

/// Prints the statuses that are not ok, or one line when all are.
void print(const char* topic, const dds::DiagnosticsMessage& message) {
  constexpr std::array<const char*, 4> kLevels{"ok", "warning", "error", "stale"};
  std::uint32_t bad = 0;
  for (std::uint32_t i = 0; i < message.status._length; ++i) {
    const auto& status = message.status._buffer[i];
    if (status.level == 0) {
      continue;
    }
    ++bad;
    const char* value = status.values._length > 0 ? shown(status.values._buffer[0].value) : "";
    std::printf("%s  %s  %s  %s  %s\n", topic, kLevels[std::min<std::size_t>(status.level, 3)],
                shown(status.name), shown(status.message), value);
  }
  if (bad == 0) {
    std::printf("%s  t %.3f s  all %u entries ok\n", topic, seconds(message.header), message.status._length);
  }
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
        reader_(participant, topic, options.ros_namespace) {}

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
      print(name_, message);
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

template <class Message>
void add_if(const std::string& wanted, const dds::DdsTopic<Message>& topic, dds_entity_t participant,
            const EchoOptions& options, std::vector<std::unique_ptr<Echo>>& echoes) {
  if (wanted == topic.name) {
    echoes.push_back(std::make_unique<TopicEcho<Message>>(participant, topic, options));
  }
}

std::vector<std::unique_ptr<Echo>> make_echoes(dds_entity_t participant, const EchoOptions& options) {
  std::vector<std::unique_ptr<Echo>> echoes;
  for (const std::string& wanted : options.topics) {
    add_if(wanted, dds::topics::kPose, participant, options, echoes);
    add_if(wanted, dds::topics::kOdom, participant, options, echoes);
    add_if(wanted, dds::topics::kAltitude, participant, options, echoes);
    add_if(wanted, dds::topics::kTf, participant, options, echoes);
    add_if(wanted, dds::topics::kTfStatic, participant, options, echoes);
    add_if(wanted, dds::topics::kMap, participant, options, echoes);
    add_if(wanted, dds::topics::kRegisteredScan, participant, options, echoes);
    add_if(wanted, dds::topics::kMapCloud, participant, options, echoes);
    add_if(wanted, dds::topics::kPressure, participant, options, echoes);
    add_if(wanted, dds::topics::kFloor, participant, options, echoes);
    add_if(wanted, dds::topics::kFloorName, participant, options, echoes);
    add_if(wanted, dds::topics::kDiagnostics, participant, options, echoes);
  }
  return echoes;
}

void run(const EchoOptions& options) {
  dds::set_library_log(&print_library_line);
  dds::ParticipantSettings settings;
  settings.domain_id = options.domain;
  settings.network_interface = options.network_interface;
  const dds::Participant participant(settings);
  if (const auto& missing = participant.interfaces().missing; !missing.empty()) {
    throw ServiceError("no network interface that is up has the name or address " + missing.front());
  }
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
                         " s on DDS domain " + std::to_string(options.domain) + "; is isobar-dds running?");
    }
  }
}

}  // namespace

void add_echo_command(CLI::App& app) {
  auto options = std::make_shared<EchoOptions>();
  CLI::App* command = app.add_subcommand("echo", "Print received DDS messages, one line each");
  command
      ->add_option("TOPIC", options->topics,
                   "pose, odom, altitude, tf, tf_static, registered_scan, map_cloud, map, floor, floor_name, "
                   "diagnostics, "
                   "fluid_pressure (--namespace base: of a base station); one or more")
      ->check(one_of({"pose", "odom", "altitude", "tf", "tf_static", "registered_scan", "map_cloud", "map",
                      "floor", "floor_name", "diagnostics", "fluid_pressure"}))
      ->capture_default_str();
  command->add_option("--domain", options->domain, "DDS domain")
      ->envname("ROS_DOMAIN_ID")
      ->check(number_within(0, 232))
      ->capture_default_str();
  command
      ->add_option(
          "--interface", options->network_interface,
          "network interfaces beside loopback, by name or address, separated by commas; default: all")
      ->type_name("NAMES");
  command
      ->add_option("--namespace", options->ros_namespace,
                   "namespace of the robot, dds.ros_namespace of its configuration")
      ->type_name("NAME");
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

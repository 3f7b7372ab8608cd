// SPDX-License-Identifier: BSD-3-Clause
// Counterparts for the tests of the base station: base stations of another make, a robot, a barometer.
#pragma once

#include <doctest/doctest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "drivers/datagram/datagram.hpp"
#include "drivers/udp/udp.hpp"
#include "tests/integration/dds/listener.hpp"
#include "tests/ipc/child_process.hpp"

namespace isobar::test {

/// Levels of diagnostic_msgs/DiagnosticStatus.
inline constexpr int kOk = 0;
inline constexpr int kWarning = 1;
inline constexpr int kError = 2;
inline constexpr int kStale = 3;

inline std::int64_t wall_ns() {
  return std::chrono::system_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

inline std::string write_config(const std::string& name, const std::string& text) {
  const std::string file = "/tmp/" + name + ".toml";
  std::ofstream(file) << "# test\n" << text;  // an empty file is refused
  return file;
}

/// Calls `step` at about 40 Hz in its own thread.
class Ticker {
 public:
  template <class Step>
  explicit Ticker(Step step)
      : thread_([this, step]() mutable {
          while (!stopped_) {
            step();
            std::this_thread::sleep_for(std::chrono::milliseconds(25));
          }
        }) {}
  ~Ticker() {
    stopped_ = true;
    thread_.join();
  }
  Ticker(const Ticker&) = delete;
  Ticker& operator=(const Ticker&) = delete;

 private:
  std::atomic<bool> stopped_{false};
  std::thread thread_;
};

/// Behaviour of a simulated base station.
struct Base {
  std::string name = "base";
  double pressure_pa = 98'000.25;
  std::int64_t clock_ahead_ns = 0;
  bool sends_twice = false;
  bool replays = false;  ///< repeats, after each sample, that of 1 s before
};

/// Base station of another make: writes both topics until destroyed.
class Sender {
 public:
  Sender(dds_entity_t participant, const Base& base)
      : base_(base),
        pressure_(participant, dds::topics::kBasePressure, base.name),
        temperature_(participant, dds::topics::kBaseTemperature, base.name),
        ticker_([this] { send(); }) {}

 private:
  void write(std::int64_t stamp_ns) {
    dds::PressureMessage message{};
    message.header = {dds::to_time(stamp_ns), dds::text("theirs")};
    message.fluid_pressure = base_.pressure_pa;
    message.variance = 0.0625;
    pressure_.write(message);
  }
  void send() {
    const std::int64_t stamp_ns = wall_ns() + base_.clock_ahead_ns;
    dds::TemperatureMessage message{};
    message.header = {dds::to_time(stamp_ns), dds::text("theirs")};
    message.temperature = 17.5;
    temperature_.write(message);
    write(stamp_ns);
    if (base_.sends_twice) write(stamp_ns);
    sent_.push_back(stamp_ns);
    if (base_.replays && sent_.size() > 40) write(sent_[sent_.size() - 40]);
  }

  Base base_;
  dds::Writer<dds::PressureMessage> pressure_;
  dds::Writer<dds::TemperatureMessage> temperature_;
  std::vector<std::int64_t> sent_;
  Ticker ticker_;
};

/// A base-station pressure that the stand-in for isobard has received and printed.
struct Got {
  double pressure_pa = 0.0;
  long age_ms = 0;
  int station = -1;
  double variance_pa2 = 0.0;
  double temperature_c = 0.0;
};

/// A wheel sample, likewise.
struct GotWheel {
  double vx_m_s = 0.0;
  double vx_variance_m2_s2 = 0.0;
  double wz_variance_rad2_s2 = 0.0;
};

/// Robot with the stand-in as isobard, and a subscriber of its diagnostics.
class Robot {
 public:
  explicit Robot(const std::string& config = "# defaults\n")
      : participant_(std::make_shared<dds::Participant>(dds::ParticipantSettings{})),
        diagnostics_(participant_, dds::topics::kDiagnostics),
        stand_in_({ISOBAR_STAND_IN}),
        bridge_({ISOBAR_DDS_PROGRAM, "--config", write_config("robot", config)}) {
    REQUIRE(diagnostics_.receive(2));  // the bridge has a health report, and so the robot clock
  }
  [[nodiscard]] dds_entity_t participant() const { return participant_->get(); }

  /// Waits until the diagnostics report this level for the entry.
  bool says(const std::string& entry, int level) {
    diagnostics_.forget();
    return diagnostics_.receive(
        1, [&](const auto& message) { return test::says(message, "isobar: " + entry, level); });
  }
  /// Whether the bridge still is the process that was started.
  bool is_same_bridge() {
    return bridge_.running() && !bridge_.read_until("restarting", std::chrono::milliseconds(100));
  }
  /// The diagnostics' text of the entry; empty: none.
  std::string text(const std::string& entry) {
    std::string found;
    diagnostics_.receive(1, [&](const auto& message) {
      found = text_of(message, "isobar: " + entry);
      return !found.empty();
    });
    return found;
  }
  /// Waits for the next samples that isobard receives, up to 20 s.
  std::vector<Got> receive(std::size_t wanted) { return receive(wanted, std::chrono::seconds(20)); }
  /// The samples that isobard receives in this time.
  std::vector<Got> receive_for(std::chrono::milliseconds time) { return receive(SIZE_MAX, time); }
  /// Forward speeds of the wheel samples that isobard receives in this time.
  std::vector<double> wheels_for(std::chrono::milliseconds time) {
    std::vector<double> speeds;
    const auto deadline = std::chrono::steady_clock::now() + time;
    std::string line;
    double speed = 0.0;
    while (std::chrono::steady_clock::now() < deadline) {
      if (stand_in_.read_line(line, std::chrono::milliseconds(100)) &&
          std::sscanf(line.c_str(), "wheel %lf", &speed) == 1) {
        speeds.push_back(speed);
      }
    }
    return speeds;
  }
  /// Waits for the next wheel samples that isobard receives, up to 20 s.
  std::vector<GotWheel> wheels(std::size_t wanted) {
    std::vector<GotWheel> samples;
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    std::string line;
    while (samples.size() < wanted && std::chrono::steady_clock::now() < deadline) {
      GotWheel got;
      if (stand_in_.read_line(line, std::chrono::milliseconds(100)) &&
          std::sscanf(line.c_str(), "wheel %lf %lf %lf", &got.vx_m_s, &got.vx_variance_m2_s2,
                      &got.wz_variance_rad2_s2) == 3) {
        samples.push_back(got);
      }
    }
    return samples;
  }
  /// Waits until isobard prints that it has received this.
  bool receives(const std::string& text) { return stand_in_.read_until(text, std::chrono::seconds(20)); }
  /// Waits until the bridge logs this.
  bool logs(const std::string& text, std::chrono::milliseconds limit = std::chrono::seconds(10)) {
    return bridge_.read_until(text, limit);
  }
  /// Discards the samples that isobard has received so far.
  void forget() {
    std::string line;
    while (stand_in_.read_line(line, std::chrono::milliseconds(0))) {
    }
  }

 private:
  std::vector<Got> receive(std::size_t wanted, std::chrono::milliseconds limit) {
    std::vector<Got> samples;
    const auto deadline = std::chrono::steady_clock::now() + limit;
    std::string line;
    while (samples.size() < wanted && std::chrono::steady_clock::now() < deadline) {
      Got got;
      if (stand_in_.read_line(line, std::chrono::milliseconds(100)) &&
          std::sscanf(line.c_str(), "base %lf %ld %d %lf %lf", &got.pressure_pa, &got.age_ms, &got.station,
                      &got.variance_pa2, &got.temperature_c) == 5) {
        samples.push_back(got);
      }
    }
    return samples;
  }

  std::shared_ptr<dds::Participant> participant_;
  Listener<dds::DiagnosticsMessage> diagnostics_;
  ChildProcess stand_in_;
  ChildProcess bridge_;
};

/// Barometer that sends datagrams, by default with 0.4 Pa of white noise.
class Barometer {
 public:
  Barometer(std::uint16_t port, datagram::Kind kind, bool sends_twice = false, double noise_pa = 0.4)
      : kind_(kind),
        sends_twice_(sends_twice),
        sender_("127.0.0.1", port),
        noise_pa_(noise_pa),
        ticker_([this] { send(); }) {}

 private:
  void send() {
    datagram::Sample sample;
    sample.kind = kind_;
    sample.pressure = {wall_ns(), 97'000.0 + noise_pa_ * noise_(random_), 21.25};
    for (int i = 0; i < (sends_twice_ ? 2 : 1); ++i) {
      sample.sequence =
          sequence_++;  // the copy has its own sequence number, so that the number does not reveal it
      std::array<char, datagram::kMaxLineBytes> line{};
      const std::size_t length = datagram::format_line(sample, line);
      sender_.send({reinterpret_cast<const std::uint8_t*>(line.data()), length});
    }
  }

  datagram::Kind kind_;
  bool sends_twice_;
  UdpSender sender_;
  std::uint32_t sequence_ = 0;
  std::mt19937_64 random_{7};
  double noise_pa_;
  std::normal_distribution<double> noise_;
  Ticker ticker_;
};

}  // namespace isobar::test

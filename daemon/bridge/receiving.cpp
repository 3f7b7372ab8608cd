// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/bridge/receiving.hpp"

#include <type_traits>
#include <utility>

#include "drivers/clock/robot_clock.hpp"
#include "ipc/dds/samples.hpp"

namespace isobar::bridge {
namespace {

template <class Stream>
void add_reader(const std::optional<Stream>& stream, std::vector<dds_entity_t>& readers) {
  if (stream) {
    readers.push_back(stream->reader.get());
  }
}

}  // namespace

std::int64_t IsobardClock::now_ns() const noexcept {
  return monotonic_ns() + offset_ns_.load(std::memory_order_relaxed);
}

Receiving::Receiving(dds_entity_t participant, dds_entity_t of_stations, const Settings& settings,
                     const IsobardClock& clock)
    : clock_(clock), imu_orientation_(settings.dds.imu_orientation) {
  const dds::DdsConfig& config = settings.dds;
  const auto open = [&](auto& stream, const auto& from, const std::string& name, const dds::InputQos& qos,
                        const auto& to) {
    stream.emplace(participant, from, config.ros_namespace, name, qos, to);
  };
  if (config.receive_base_pressure && !settings.is_base_station && of_stations != 0) {
    base_pressure_.emplace(ipc::topics::kBaseBarometer);
    stations_.push_back(std::make_unique<StationInput>(of_stations, config, config.base_station, 0));
    if (!config.second_base_station.empty()) {
      stations_.push_back(std::make_unique<StationInput>(of_stations, config, config.second_base_station, 1));
    }
  }
  if (settings.receives_points) cloud_ = std::make_unique<CloudInput>(participant, settings);
  if (config.receive_initial_pose && !settings.is_base_station) {
    hints_ = std::make_unique<PoseHintInput>(participant, config);
  }
  if (settings.receives_pressure) {
    open(pressure_, dds::topics::kPressure, config.topics.pressure, config.input_qos.pressure,
         ipc::topics::kBarometer);
  }
  if (settings.receives_imu)
    open(imu_, dds::topics::kImu, config.topics.imu, config.input_qos.imu, ipc::topics::kImu);
  if (settings.receives_wheel && config.wheel_type == "twist") {
    open(wheel_twist_, dds::topics::kWheelTwist, config.topics.wheel, config.input_qos.wheel,
         ipc::topics::kWheel);
  } else if (settings.receives_wheel) {
    open(wheel_, dds::topics::kWheel, config.topics.wheel, config.input_qos.wheel, ipc::topics::kWheel);
  }
  wait_for_data(participant);
  watch_writers(participant, of_stations);
  thread_ = std::thread([this] { loop(); });
}

void Receiving::wait_for_data(dds_entity_t participant) {
  // Not of a participant: such a wait set would refuse the readers of the other one.
  waitset_ = dds::checked(dds_create_waitset(DDS_CYCLONEDDS_HANDLE), "wait set");
  stop_ = dds::checked(dds_create_guardcondition(participant), "guard condition");
  dds_waitset_attach(waitset_.get(), stop_.get(), 0);
  const auto attach = [this](const auto& stream) {
    if (!stream) {
      return;
    }
    dds_set_status_mask(stream->reader.get(), DDS_DATA_AVAILABLE_STATUS);
    dds_waitset_attach(waitset_.get(), stream->reader.get(), 0);
  };
  if (cloud_) {
    dds_set_status_mask(cloud_->reader(), DDS_DATA_AVAILABLE_STATUS);
    dds_waitset_attach(waitset_.get(), cloud_->reader(), 0);
  }
  if (hints_) dds_waitset_attach(waitset_.get(), hints_->reader(), 0);
  attach(pressure_);
  attach(imu_);
  attach(wheel_);
  attach(wheel_twist_);
  for (const auto& station : stations_) {
    dds_waitset_attach(waitset_.get(), station->pressure_reader(), 0);
  }
}

void Receiving::watch_writers(dds_entity_t participant, dds_entity_t of_stations) {
  Watched sensors{dds::WriterWatch(participant), {}};
  if (cloud_) sensors.inputs.push_back({"points", cloud_->reader()});
  if (hints_) sensors.inputs.push_back({"initial_pose", hints_->reader()});
  if (pressure_) sensors.inputs.push_back({"pressure", pressure_->reader.get()});
  if (imu_) sensors.inputs.push_back({"imu", imu_->reader.get()});
  if (wheel_) sensors.inputs.push_back({"wheel", wheel_->reader.get()});
  if (wheel_twist_) sensors.inputs.push_back({"wheel", wheel_twist_->reader.get()});
  if (!sensors.inputs.empty()) watched_.push_back(std::move(sensors));
  if (stations_.empty()) return;
  watched_.push_back(
      {dds::WriterWatch(of_stations), {{"base_pressure", stations_.front()->pressure_reader()}}});
}

std::vector<InputState> Receiving::states() {
  std::vector<InputState> states;
  for (Watched& watched : watched_) {
    watched.writers.look();
    for (const dds::InputReader& input : watched.inputs) {
      states.push_back({input.input, watched.writers.trouble(input)});
    }
  }
  return states;
}

Receiving::~Receiving() {
  dds_set_guardcondition(stop_.get(), true);
  thread_.join();
}

std::vector<dds_entity_t> Receiving::readers() const {
  std::vector<dds_entity_t> readers;
  for (const auto& station : stations_) {
    readers.push_back(station->pressure_reader());
    readers.push_back(station->temperature_reader());
  }
  if (cloud_) readers.push_back(cloud_->reader());
  if (hints_) readers.push_back(hints_->reader());
  add_reader(pressure_, readers);
  add_reader(imu_, readers);
  add_reader(wheel_, readers);
  add_reader(wheel_twist_, readers);
  return readers;
}

ReceivedCounts Receiving::counts() const noexcept {
  return {refused_.load(std::memory_order_relaxed) + (cloud_ ? cloud_->refused() : 0),
          other_senders_.load(std::memory_order_relaxed) + (cloud_ ? cloud_->other_senders() : 0),
          too_early_.load(std::memory_order_relaxed),
          refused_hints_.get(),
          station_status_.get(),
          stations_.size(),
          clock_.now_ns()};
}

template <class Message, class Sample>
void Receiving::forward(std::optional<Stream<Message, Sample>>& stream) {
  if (!stream) {
    return;
  }
  stream->reader.take([&](const Message& message, dds_instance_handle_t writer) {
    Sample sample;
    if (dds::to_sample(message, sample) != nullptr) {
      refused_.fetch_add(1, std::memory_order_relaxed);
      return;
    }
    if (!clock_.known()) {
      too_early_.fetch_add(1, std::memory_order_relaxed);
      return;
    }
    const auto is_present = [&](dds_instance_handle_t other) { return stream->reader.is_matched(other); };
    if (!stream->writer.admits(writer, monotonic_ns(), is_present)) {
      other_senders_.fetch_add(1, std::memory_order_relaxed);
      return;
    }
    // The sender's clock is that of another machine, or this machine's system clock, which can step.
    const std::int64_t now_ns = clock_.now_ns();
    const std::int64_t stamp_ns = stream->sender_clock.without_steps_ns(
        sample.stamp_ns, now_ns - stream->anchor.offset_ns(), stream->anchored, system_clock_);
    static_cast<void>(stream->anchor.add(stamp_ns, now_ns));
    stream->anchored = true;
    sample.stamp_ns = stream->anchor.to_host_ns(stream->anchor.device_unwrapped_ns());
    sample.timing = {now_ns, stream->anchor.device_ahead_ns()};
    if constexpr (std::is_same_v<Sample, ImuSample>)
      sample.has_attitude = sample.has_attitude && imu_orientation_;
    sample.path = SamplePath::kDds;
    if (!stream->publisher.send(sample)) too_early_.fetch_add(1, std::memory_order_relaxed);
  });
}

void Receiving::forward_cloud() {
  if (!cloud_) return;
  if (clock_.known()) {
    cloud_->take(clock_.now_ns(), system_clock_);
  } else {
    cloud_->drop();
  }
}

void Receiving::forward_hints() {
  if (!hints_) return;
  too_early_.fetch_add(hints_->take(), std::memory_order_relaxed);
  refused_hints_.put(hints_->refused());
}

void Receiving::forward_stations() {
  std::array<BaseStationStatus, 2> status;
  for (std::size_t i = 0; i < stations_.size(); ++i) {
    if (clock_.known()) {
      refused_.fetch_add(stations_[i]->take(clock_.now_ns(), system_clock_,
                                            [this](const PressureSample& sample) {
                                              if (!base_pressure_->send(sample)) {
                                                too_early_.fetch_add(1, std::memory_order_relaxed);
                                              }
                                            }),
                         std::memory_order_relaxed);
    } else {
      too_early_.fetch_add(stations_[i]->drop(), std::memory_order_relaxed);
    }
    status[i] = stations_[i]->status();
  }
  station_status_.put(status);
}

void Receiving::loop() noexcept {
  bool stopped = false;
  while (!stopped && dds_waitset_wait(waitset_.get(), nullptr, 0, DDS_INFINITY) >= 0) {
    system_clock_.note(read_clocks());
    forward_stations();
    forward(wheel_);
    forward(wheel_twist_);
    forward(pressure_);
    forward(imu_);
    forward_cloud();
    forward_hints();
    static_cast<void>(dds_read_guardcondition(stop_.get(), &stopped));
  }
}

}  // namespace isobar::bridge

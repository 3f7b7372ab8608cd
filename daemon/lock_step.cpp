// SPDX-License-Identifier: BSD-3-Clause
#include "daemon/lock_step.hpp"

#include <utility>

#include "run/tile_store/scan_journal.hpp"

namespace isobar {

namespace {

/// Admission in lock step: a scan is admissible once a prior reaches its end (no tolerance), or in finish().
constexpr ScanQueueConfig kLockStepQueue{.reach_ns = 0, .wait_ns = 1, .admission = ScanAdmission::kEvery};

}  // namespace

LockStep::LockStep(const StageSettings& settings, EstimateSink& sink, TileStorage* storage,
                   std::unique_ptr<LoopFiles> loop_files, MapExchange exchange)
    : sender_(settings.lidar_sender),
      assembler_(make_lidar_decoder(settings.lidar), settings.lidar.time),
      clouds_(settings.lidar.limits),
      prior_estimator_(settings.prior),
      registration_(settings.registration, settings.method, settings.T_base_lidar, sink),
      map_config_(settings.map),
      T_base_lidar_(settings.T_base_lidar),
      map_(std::make_unique<LocalMap>(settings.map, settings.T_base_lidar, storage)),
      exchange_(std::move(exchange)),
      loops_(settings, std::move(loop_files)),
      place_(settings, [this](std::uint32_t session) { return read_map(session); }),
      filling_(std::make_unique<Scan>()),
      queue_(kLockStepQueue),
      has_imu_(settings.prior.has_imu),
      uses_wheels_(settings.uses_wheels),
      imu_of_lidar_(settings.imu_of_lidar) {}

void LockStep::continue_from(const RunStart& start, const std::filesystem::path& map_folder) {
  prior_estimator_.resume(start.datum);
  registration_.begin_at(start.session, start.place);
  registration_.wait_for_place(static_cast<bool>(maps_.read));
  if (!start.place) return;
  place_.begin_at(start, false);
  map_->load_around(start.place->T_map_base.translation());
  ScanJournal::read(map_folder, [this](const RegisteredScan& scan) { map_->update(scan); });
}

void LockStep::localise_in(const RunStart& start) {
  localises_ = true;
  prior_estimator_.resume(start.datum);
  registration_.begin_at(start.session, start.place);
  registration_.wait_for_place(true);
  registration_.stay_in(*start.place);
  place_.begin_at(start, true);
  map_->load_around(start.place->T_map_base.translation());
}

std::shared_ptr<const KnownMap> LockStep::read_map(std::uint32_t session) {
  if (!maps_.read) return nullptr;
  if (!localises_) map_->store_all();
  return maps_.read(session);
}

void LockStep::handle(const recording::Event& event) {
  if (!has_imu_) {
    if (event.kind == recording::EventKind::kImu) return;  // not even as a clock
    advance(event.stamp_ns);
  }
  switch (event.kind) {
    case recording::EventKind::kLidarPacket:
      take_packet(event);
      break;
    case recording::EventKind::kCloud:
      take_cloud(*event.cloud);
      break;
    case recording::EventKind::kImu:
      if (!imu_of_lidar_) take_imu(event.imu);
      break;
    case recording::EventKind::kPressure:
      prior_estimator_.add_pressure(event.pressure);
      break;
    case recording::EventKind::kBasePressure:
      prior_estimator_.add_base_pressure(event.pressure);
      break;
    case recording::EventKind::kWheel:
      if (uses_wheels_) prior_estimator_.add_wheel(event.wheel);
      break;
  }
}

void LockStep::finish() {
  if (assembler_.flush(*filling_)) queue_scan();
  clock_ns_ += kLockStepQueue.wait_ns;
  register_admissible();
  if (localises_) return;
  exchange_map(loops_.finish([] { return true; }));
  map_->store_all();
}

void LockStep::take_packet(const recording::Event& event) {
  if (!sender_.admits(assembler_.decoder(), event.packet, event.sender_ipv4, event.stamp_ns)) return;
  if (assembler_.add_packet(event.packet, event.stamp_ns, *filling_).scan_complete) {
    queue_scan();
    register_admissible();
  }
  ImuSample sample;
  while (imu_of_lidar_ && assembler_.take_imu(sample)) take_imu(sample);
}

void LockStep::take_cloud(const recording::CloudRecord& cloud) {
  if (!clouds_.decode(cloud, *filling_)) return;
  queue_scan();
  register_admissible();
}

void LockStep::take_imu(const ImuSample& sample) {
  Prior prior;
  if (prior_estimator_.add_imu(sample, prior)) use_prior(prior);
}

void LockStep::advance(std::int64_t now_ns) {
  Prior prior;
  for (std::int64_t stamp_ns = 0; pace_.next(now_ns, stamp_ns);) {
    if (prior_estimator_.advance(stamp_ns, prior)) use_prior(prior);
  }
}

void LockStep::use_prior(const Prior& prior) {
  registration_.add_prior(prior);
  loops_.add_prior(prior);
  place_.add_prior(prior);
  register_admissible();
  registration_.bridge_silence();
}

void LockStep::queue_scan() {
  queue_.push(std::move(filling_), clock_ns_);
  if (spare_.empty()) {
    filling_ = std::make_unique<Scan>();
  } else {
    filling_ = std::move(spare_.back());
    spare_.pop_back();
  }
}

void LockStep::register_admissible() {
  while (auto scan = queue_.take(clock_ns_, registration_.newest_prior_ns())) {
    registration_.register_scan(*scan, *map_->snapshot(), registered_);
    spare_.push_back(std::move(scan));
    ++scans_;
    find_place();
    insert_scan();
    if (!localises_) exchange_map(loops_.add_scan(registered_));
  }
}

void LockStep::exchange_map(std::optional<MovedMap> moved) {
  if (!moved) return;
  map_ = std::move(moved->map);
  map_->change_storage(exchange_());
}

void LockStep::insert_scan() {
  const std::uint32_t session = registered_.pose.session;
  if (session != map_->session()) {
    map_->store_all();
    map_ = std::make_unique<LocalMap>(map_config_, T_base_lidar_, maps_.open ? maps_.open(session) : nullptr,
                                      session);
  }
  if (localises_) {
    map_->follow(registered_.pose);
  } else {
    map_->update(registered_);
  }
}

void LockStep::find_place() {
  const PlaceOrder order = place_.add_scan(registered_);
  if (order.give_up) registration_.give_up_place();
  if (!order.T_map_odom) return;
  const PlaceHint hint = order.hint_at(registered_.pose);
  map_->load_around({hint.p_map_m.x(), hint.p_map_m.y(), hint.z_m});
  registration_.offer_place(hint);
}

}  // namespace isobar

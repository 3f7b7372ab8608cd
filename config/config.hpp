// SPDX-License-Identifier: BSD-3-Clause
// The configuration as plain values with their defaults. Ranges and reasons stand in the settings table
// (setting.hpp). A replay takes sensors and mounts from the recording, the rest from here.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/sources.hpp"
#include "core/estimates.hpp"
#include "core/floors/grid_config.hpp"
#include "core/geometry.hpp"
#include "core/loops/loop_config.hpp"
#include "core/map/map_config.hpp"
#include "core/name_table.hpp"
#include "core/prior/prior_config.hpp"
#include "core/registration/registration_config.hpp"
#include "drivers/bmp390/settings.hpp"
#include "drivers/bmp581/settings.hpp"
#include "drivers/dps310/settings.hpp"
#include "drivers/encoder/settings.hpp"
#include "drivers/icp20100/settings.hpp"
#include "drivers/iio/settings.hpp"
#include "drivers/lidar/lidar_time.hpp"
#include "drivers/ms5611/settings.hpp"
#include "drivers/pps/settings.hpp"
#include "drivers/vn100/settings.hpp"
#include "drivers/xsens/settings.hpp"
#include "ipc/dds_config.hpp"

namespace isobar {

/// Role of this machine: decides which threads run.
enum class Role : std::uint8_t {
  kRobot,        ///< estimates its pose
  kBaseStation,  ///< stands still, reads a barometer and publishes its pressure
};

inline constexpr NameTable<Role, 2> kRoleNames{{{
    {Role::kRobot, "robot"},
    {Role::kBaseStation, "base-station"},
}}};

/// [lidar]
struct LidarSettings {
  LidarSource source = LidarSource::kDriver;
  std::string model = "VLP-16";     ///< a name of drivers/lidar_models
  std::string address = "0.0.0.0";  ///< IPv4 address on which packets are received
  std::uint16_t port = 2368;        ///< UDP port of the data packets
  std::uint16_t info_port = 0;      ///< UDP port of its IMU, position or device information; 0: the model's
  std::string calibration_file;     ///< of this sensor, see LidarConfig; empty: none
  LidarTime time = LidarTime::kReceive;  ///< clock that stamps the points
  std::string sender;                    ///< IPv4 address of the lidar; empty: the first that sends
  Mount mount;                           ///< of the sensor in base_link
  double min_range_m = 0.3;              ///< these four: see LidarLimits
  double max_range_m = 300.0;
  double mask_start_deg = 0.0;
  double mask_end_deg = 0.0;
};

/// [imu]
struct ImuSettings {
  ImuSource source = ImuSource::kDatagram;
  Mount mount;
  vn100::Settings vn100;
  xsens::Settings xsens;
  iio::ImuBufferSettings iio;
  [[nodiscard]] bool present() const { return source != ImuSource::kNone; }
};

/// [barometer]
struct BarometerSettings {
  BarometerSource source = BarometerSource::kDatagram;
  Mount mount;  ///< position of the pressure port in base_link; the rotation is not used
  /// Calibration file to load into PriorConfig::compensation; empty after loading.
  std::string compensation_file;
  /// Time without a change of a single bit after which a sensor of this machine is stuck [s]; 0: never.
  double stuck_time_s = 1.5;
  dps310::Settings dps310;
  bmp581::Settings bmp581;
  bmp390::Settings bmp390;
  icp20100::Settings icp20100;
  ms5611::Settings ms5611;
  iio::SetraSettings setra278;
  iio::Settings iio;
  [[nodiscard]] bool present() const { return source != BarometerSource::kNone; }
  /// Configured rate of the sensor of this machine [Hz]; 0: the samples come another way.
  [[nodiscard]] int rate_hz() const noexcept;
};

/// [wheel]
struct WheelSettings {
  WheelSource source = WheelSource::kDatagram;
  encoder::Settings encoder;
  [[nodiscard]] bool present() const { return source != WheelSource::kNone; }
};

/// [base_barometer]
struct BaseBarometerSettings {
  std::string compensation_file;  ///< to load into PriorConfig::base_compensation; empty after loading
};

/// [input]: sample datagrams of IMU, barometers and wheels (drivers/datagram/datagram.hpp)
struct InputSettings {
  std::string address = "127.0.0.1";
  std::string senders;  ///< IPv4 addresses, separated by commas, whose datagrams are taken; empty: any
  std::uint16_t port = 7373;
  bool expect_wheels = false;       ///< health: wheels that were never heard are missing, not absent
  bool expect_base_station = true;  ///< the same for the base station
};

/// [output]
struct OutputSettings {
  std::string directory;          ///< for trajectory, map and status of a live run; empty: none written
  double cloud_interval_s = 2.0;  ///< between two map clouds for viewers
};

/// [map]: its files
struct MapFileSettings {
  std::string directory;     ///< for a live run's tiles; empty: map/ in output.directory, if that is set
  double max_disk_gb = 4.0;  ///< beyond it the oldest tile file is deleted
  std::string stored;        ///< folder of a stored map, or of a run with one; empty: that of the run itself
  MapUse use = MapUse::kExtend;
};

/// [black_box]
struct BlackBoxSettings {
  double span_s = 60.0;         ///< time span of the inputs kept in memory; 0: off
  double max_mb = 160.0;        ///< most memory for them
  std::string directory;        ///< for saved recordings; empty: blackbox/ in output.directory
  int keep = 10;                ///< newest recordings kept in it
  double min_free_mb = 500.0;   ///< free space that a save leaves on the disk
  std::string save_on = "any";  ///< health entries whose fault saves; "any", "none", or names
};

/// [realtime]; deadlines in ms
struct RealtimeSettings {
  bool enabled = false;        ///< SCHED_FIFO, and all memory locked in RAM
  int inertial_priority = 55;  ///< SCHED_FIFO priorities
  int prior_priority = 55;
  int lidar_priority = 45;
  int registration_priority = 40;
  std::vector<int> estimator_cpus;         ///< cores for lidar, inertial, prior and registration; empty: all
  std::vector<int> map_cpus;               ///< cores for the map thread; empty: all
  double lidar_deadline_ms = 10.0;         ///< from the end of a scan to its hand-over
  double prior_deadline_ms = 10.0;         ///< from an IMU sample to the hand-over of its prior
  double registration_deadline_ms = 50.0;  ///< from the end of a scan to the hand-over of its pose
  double map_deadline_ms = 100.0;          ///< from the hand-over of a pose to the map with its scan
  double prior_reach_ms = 6.0;             ///< see ScanQueueConfig
  double prior_wait_ms = 50.0;             ///< see ScanQueueConfig
};

/// [floors]
struct FloorSettings {
  bool enabled = true;
  double interval_s = 1.0;
  double cpu_share = 0.2;
  GridConfig grid;
};

struct Config {
  Role role = Role::kRobot;
  Method method = Method::kAdaptive;
  LidarSettings lidar;
  ImuSettings imu;
  BarometerSettings barometer;
  WheelSettings wheel;
  BaseBarometerSettings base_barometer;
  InputSettings input;
  OutputSettings output;
  pps::Settings pps;  ///< [pps]
  BlackBoxSettings black_box;
  dds::DdsConfig dds;  ///< [dds]
  RealtimeSettings realtime;
  /// Mounts in here (T_base_imu, p_base_port) are filled from [imu] and [barometer], or from the recording.
  PriorConfig prior;
  RegistrationConfig registration;
  MapConfig map;
  MapFileSettings map_files;
  LoopConfig loops;
  FloorSettings floors;
};

}  // namespace isobar

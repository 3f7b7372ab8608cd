// SPDX-License-Identifier: BSD-3-Clause
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "config/config_io.hpp"
#include "config/setting.hpp"
#include "config/setting_rules.hpp"
#include "config/value_text.hpp"
#include "core/errors.hpp"

namespace isobar::test::test_config {

namespace {

void fails(const std::string& text, const std::string& words) {
  CAPTURE(text);
  CHECK_THROWS_WITH_AS(parse_config(text, "c.toml"), doctest::Contains(words.c_str()), ConfigError);
}

/// Changes a setting to another value within its rules.
struct Change {
  const Setting& setting;
  void operator()(double* v) const {
    *v =
        *v * 0.75 + 0.25 * (*v > 0.5 * (setting.lowest + setting.highest) ? setting.lowest : setting.highest);
  }
  void operator()(bool* v) const { *v = !*v; }
  void operator()(std::string* v) const {
    const bool is_address = setting.text_rule == TextRule::kIpv4 ||
                            setting.text_rule == TextRule::kIpv4OrEmpty ||
                            setting.text_rule == TextRule::kIpv4List;
    *v = !setting.choices.empty() ? setting.choices.back() : is_address ? "192.0.2.1" : "other";
  }
  void operator()(Eigen::Vector3d* v) const { *v += Eigen::Vector3d(1.0 / 3.0, -2.5, 1e-7); }
  void operator()(std::vector<int>* v) const { *v = {1, 0}; }
  void operator()(Role* v) const { *v = Role::kBaseStation; }
  void operator()(Method* v) const { *v = Method::kOdometry; }
  void operator()(Matcher* v) const { *v = Matcher::kNearest; }
  void operator()(AirTemperatureMode* v) const { *v = AirTemperatureMode::kFixed; }
  void operator()(CompensationModel* v) const { *v = CompensationModel::kSimple; }
  void operator()(std::vector<double>* v) const { *v = {1.5, -1.0 / 3.0}; }
  template <typename Integer>
  void operator()(Integer* v) const {
    if constexpr (std::is_enum_v<Integer>) {
      const auto last = static_cast<Integer>(setting.choices.size() - 1);
      *v = *v == last ? Integer{} : last;
    } else {
      *v = !setting.choices.empty() ? static_cast<Integer>(std::stoi(setting.choices.back()))
                                    : static_cast<Integer>(*v > setting.lowest ? *v - 1 : *v + 1);
    }
  }
};

}  // namespace

TEST_CASE("config/isobar.toml is up to date: it equals the output of `isobar config show`") {
  std::ifstream in(std::filesystem::path(ISOBAR_SOURCE_DIR) / "config/isobar.toml", std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  // If this fails: build/release/tools/isobar config show > config/isobar.toml
  CHECK(text.str() == show_config(Config{}));
}

TEST_CASE("The shown text loads as the same settings, with defaults and with changed values") {
  const std::string defaults = show_config(Config{});
  CHECK(show_config(parse_config(defaults, "c.toml")) == defaults);
  for (const Setting& setting : [] {
         static Config unchanged;
         return settings_of(unchanged);
       }()) {
    Config config;
    auto settings = settings_of(config);
    const auto same = std::find_if(settings.begin(), settings.end(),
                                   [&](const Setting& s) { return s.key == setting.key; });
    std::visit(Change{*same}, same->target);
    const std::string line = value_text(*same);
    CAPTURE(setting.key);
    CHECK(line != value_text(setting));
    std::string toml = setting.section().empty() ? "" : "[" + setting.section() + "]\n";
    toml += setting.name() + " = " + line + "\n";
    Config loaded;
    try {
      loaded = parse_config(toml, "c.toml");
    } catch (const ConfigError& error) {
      // Some pairs must change together; then the error names the other key.
      CHECK(std::string(error.what()).find("must") != std::string::npos);
      continue;
    }
    CHECK(show_config(loaded) == show_config(config));
    CHECK(show_config(loaded) != defaults);
  }
}

TEST_CASE("Addresses of senders: one or none for the lidar, a list for the sample datagrams") {
  fails("[lidar]\nsender = \"192.168.1\"", "lidar.sender: must be empty, or an IPv4 address");
  fails("[input]\nsenders = \"192.168.1.50,\"", "input.senders: must be empty, or up to 16 IPv4 addresses");
  fails("[input]\nsenders = \"192.168.1.50 192.168.1.51\"", "input.senders");
  CHECK(parse_config("[input]\nsenders = \"192.168.1.50, 192.168.1.51\"", "c.toml").input.senders ==
        "192.168.1.50, 192.168.1.51");
  CHECK(parse_config("[lidar]\nsender = \"192.168.1.201\"", "c.toml").lidar.sender == "192.168.1.201");
}

TEST_CASE("Every key is unique and documented, and its default is within its own rule") {
  Config config;
  std::set<std::string> keys;
  for (const Setting& setting : settings_of(config)) {
    CAPTURE(setting.key);
    CHECK(keys.insert(setting.key).second);
    CHECK(setting.doc.size() > 30);
    CHECK(setting.doc.back() == '.');
    CHECK(setting.doc.find("…") == std::string::npos);  // complete without the next key's text
    CHECK(keeps_rule(setting));
    CHECK((setting.section().empty() || !section_doc(setting.section()).empty()));
    if (std::holds_alternative<double*>(setting.target)) {
      CHECK(std::isfinite(setting.lowest));
      CHECK(std::isfinite(setting.highest));
    }
  }
  CHECK(keys.size() > 100);
}

TEST_CASE("Every number and switch of the algorithms' configuration structs has a key") {
  Config config;
  std::set<std::string> names;
  for (const Setting& setting : settings_of(config)) {
    names.insert(setting.name());
  }
  const std::regex field(R"(\n  (?:double|bool|int|std::size_t|std::uint32_t|AirTemperatureMode) (\w+) = )");
  for (const char* header :
       {"core/altitude/altitude_config.hpp", "core/prior/prior_config.hpp", "core/map/map_config.hpp",
        "core/registration/registration_config.hpp", "ipc/dds_config.hpp"}) {
    std::ifstream in(std::filesystem::path(ISOBAR_SOURCE_DIR) / header);
    const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    std::size_t fields = 0;
    for (std::sregex_iterator match(text.begin(), text.end(), field), end; match != end; ++match, ++fields) {
      const std::string name = (*match)[1];
      CAPTURE(header);
      CAPTURE(name);
      if (name == "has_imu") continue;  // filled from imu.source
      if (name == "depth") continue;    // of each input: dds.qos.imu_depth
      CHECK(names.count(name) == 1);
    }
    CHECK(fields > 5);
  }
}

TEST_CASE("Values outside their rules are refused with file, line, column, key, rule and value") {
  fails("[lidar]\nport = 70000\n",
        "c.toml:2:8: lidar.port: must be a whole number within 1 … 65535 (got 70000)");
  fails("[lidar]\nport = 1.5\n", "must be a whole number");
  fails("[lidar]\nport = \"2368\"\n", "got '2368'");
  fails("[lidar]\nmodel = \"VLS-128\"\n",
        "lidar.model: must be one of VLP-16, VLP-16 Hi-Res, VLP-32C, HDL-32E, ");
  fails("[lidar]\naddress = \"localhost\"\n", "lidar.address: must be an IPv4 address");
  fails("[lidar]\nxyz_m = [0, 0]\n", "lidar.xyz_m: must be three numbers");
  fails("[lidar]\nxyz_m = [0, 0, nan]\n", "lidar.xyz_m");
  fails("[lidar]\nxyz_m = [0, 0, 1e9]\n", "within -100 … 100 m");
  fails("[registration]\nmax_range_m = inf\n", "registration.max_range_m");
  fails("[registration]\nmax_iterations = 0\n", "within 1 … 50");
  fails("[realtime]\nenabled = 1\n", "must be true or false");
  fails("[realtime]\nmap_cpus = [0, -1]\n", "realtime.map_cpus");
  fails("[realtime]\nmap_cpus = 3\n", "realtime.map_cpus");
  fails("method = \"5dof\"\n",
        "must be one of 6dof, 4dof, 3dof, 6dof-altitude, 4dof-altitude, odometry, adaptive (got '5dof')");
  fails("method = 3\n", "must be one of");
  fails("[dds]\nros_gid_bytes = 20\n", "must be one of 16, 24");
  fails("[dds]\nmap_frame = \"/map\"\n", "dds.map_frame");
  fails("lidar = 3\n", "must be a section");
  fails("[method]\n", "must be one of");
  fails("[altimeter]\nmin_pressure_pa = 118000.0\n", "must be below altimeter.max_pressure_pa");
}

TEST_CASE("A robot may have no IMU and no barometer; a base station has a barometer") {
  const Config config = parse_config("[imu]\nsource = \"none\"\n[barometer]\nsource = \"none\"", "c.toml");
  CHECK_FALSE(config.imu.present());
  CHECK_FALSE(config.barometer.present());
  CHECK(Config{}.imu.present());
  fails("role = \"base-station\"\n[barometer]\nsource = \"none\"",
        "barometer.source: must not be \"none\": a base station measures air pressure");
  fails("[imu]\nsource = \"off\"", "imu.source: must be one of datagram, dds, none");
  fails("[imu]\nsource = \"input\"", "(got 'input')");
  fails("[dds]\nreceive_sensors = true\n", "dds.receive_sensors: replaced by imu.source = \"dds\"");
}

TEST_CASE("Impossible rates of a barometer are refused if that barometer is in use") {
  const std::string greedy = "[barometer.dps310]\npressure_rate_hz = 32\npressure_oversampling = 64\n";
  fails("[barometer]\nsource = \"dps310\"\n" + greedy,
        "c.toml:4:20: barometer.dps310.pressure_rate_hz: pressure 32 x 104.4 ms and temperature 4 x 14.8 ms "
        "are "
        "3.4 s of "
        "measuring in a second, must be below 1");
  CHECK(parse_config(greedy, "c.toml").barometer.dps310.pressure_oversampling == 64);
  CHECK(parse_config("[barometer]\nsource = \"dps310\"\n", "c.toml").barometer.source ==
        BarometerSource::kDps310);
  fails("[barometer.dps310]\npressure_rate_hz = 30\n", "must be one of 1, 2, 4, 8, 16, 32, 64, 128");
  fails("barometer.source = \"bmp581\"\nbarometer.bmp581.pressure_oversampling = 64\n",
        "barometer.bmp581.rate_hz: 50 measurements of 41.4 ms are 2.07 s of measuring in a second, must be "
        "below 1; lower the rate or an oversampling");
  fails("barometer.source = \"ms5611\"\nbarometer.ms5611.rate_hz = 100\n", "barometer.ms5611.rate_hz: 100");
  fails("barometer.source = \"bmp390\"\nbarometer.bmp390.rate_hz = 100\n", "barometer.bmp390.rate_hz: 100");
  fails("barometer.bmp390.rate_hz = 60\n", "must be one of 25, 50, 100, 200");
  fails("[barometer.dps310]\naddress = \"0x78\"\n", "must be one of 0x77, 0x76");
  fails("[barometer]\nsource = \"setra278\"\n[barometer.setra278]\nlow_v = 3.0\n",
        "barometer.setra278: high_v must be above low_v");
  fails("[barometer]\nsource = \"bmp280\"\n",
        "must be one of datagram, dds, none, dps310, bmp581, bmp390, icp20100, ms5611, setra278, iio");
}

TEST_CASE("An IMU on a serial line needs a line that carries its rate, and its barometer needs the IMU") {
  const Config config = parse_config(
      "imu.source = \"vn100\"\nbarometer.source = \"imu\"\nimu.vn100.port = \"/dev/imu\"", "c.toml");
  CHECK(config.imu.source == ImuSource::kVn100);
  CHECK(config.imu.vn100.port == "/dev/imu");
  CHECK(config.barometer.source == BarometerSource::kImu);
  fails("[imu]\nsource = \"vn100\"\n[imu.vn100]\nrate_hz = 400\n",
        "c.toml:4:11: imu.vn100.rate_hz: the packets fill more than 0.9 of the line: raise baud or lower "
        "rate_hz");
  fails("[imu]\nsource = \"vn100\"\n[imu.vn100]\nrate_hz = 300\n", "must divide the sensor's 800 Hz");
  fails("[imu]\nsource = \"xsens\"\n[imu.xsens]\nrate_hz = 200\n", "imu.xsens.rate_hz: the messages fill");
  CHECK(parse_config("[imu.xsens]\nrate_hz = 200\n", "c.toml").imu.xsens.rate_hz == 200);  // not in use
  fails("[barometer]\nsource = \"imu\"\n",
        "must not be \"imu\" without imu.source \"vn100\" or \"xsens\", on a robot");
  fails("[imu]\nsource = \"iio\"\n[barometer]\nsource = \"imu\"\n", "must not be \"imu\" without");
}

TEST_CASE("A base station is configured in three lines, and only the keys it uses are shown") {
  const Config base = parse_config("role = \"base-station\"\n[dds]\nbase_station = \"roof\"\n", "c.toml");
  CHECK(base.role == Role::kBaseStation);
  CHECK(base.dds.base_station == "roof");
  const std::string shown = show_config(base);
  CHECK(show_config(parse_config(shown, "c.toml")) == shown);
  for (const char* section :
       {"\nlidar.", "\nimu.", "\noutput.", "\ndds.propagator.", "\naltimeter.air.", "\nattitude.",
        "\nheight.", "\nlimits.", "\nregistration.", "\nmap.", "\nmethod ="}) {
    CAPTURE(section);
    CHECK(shown.find(section) == std::string::npos);
  }
  for (const char* key :
       {"\ninput.port = 7373", "\ndds.base_station = \"roof\"", "\naltimeter.stuck_timeout_s ="}) {
    CAPTURE(key);
    CHECK(shown.find(key) != std::string::npos);
  }
}

TEST_CASE("Keys that a base station does not use are refused for that role only") {
  const std::string role = "role = \"base-station\"\n";
  fails(role + "[lidar]\nport = 2369\n", "c.toml:3:8: lidar.port: is not used where role = \"base-station\"");
  fails(role + "method = \"3dof\"\n", "c.toml:2:10: method: is not used");
  fails(role + "[dds]\nreceive_base_pressure = true\n", "dds.receive_base_pressure: is not used");
  fails(role + "[dds.propagator]\nslew_time_s = 0.2\n", "dds.propagator.slew_time_s: is not used");
  fails("role = \"base station\"\n", "role: must be one of robot, base-station (got 'base station')");
  fails("[dds]\nis_base_station = true\n", "dds.is_base_station: unknown key");
  fails("[dds]\nsecond_base_station = \"base\"\n",
        "dds.second_base_station: must differ from dds.base_station");
  CHECK(parse_config("role = \"robot\"\n[lidar]\nport = 2369\n", "c.toml").lidar.port == 2369);
}

TEST_CASE("Basic settings are shown first, and with --basic alone") {
  const std::string all = show_config(Config{});
  const std::string basic = show_config(Config{}, Shown::kBasic);
  // Both end with the end mark.
  CHECK(all.starts_with(basic.substr(0, basic.rfind("# end of configuration"))));
  CHECK(basic.size() * 5 < all.size());
  Config config;
  std::size_t basic_settings = 0;
  for (const Setting& setting : settings_of(config)) {
    CAPTURE(setting.key);
    const bool is_basic = setting.audience == Audience::kBasic;
    CHECK((basic.find("\n" + setting.key + " = ") != std::string::npos) == is_basic);
    CHECK(all.find("\n" + setting.key + " = ") != std::string::npos);
    basic_settings += is_basic ? 1 : 0;
  }
  CHECK(basic_settings == 20);
  CHECK_NOTHROW(parse_config(basic, "c.toml"));
}

TEST_CASE("Keys load alike in sections and spelled with dots, in any order") {
  const std::string expected =
      show_config(parse_config("[dds]\ndomain_id = 7\n[lidar]\nport = 9\n", "c.toml"));
  CHECK(show_config(parse_config("lidar.port = 9\ndds.domain_id = 7\n", "c.toml")) == expected);
  CHECK(parse_config("barometer.source = \"iio\"\n[barometer.iio]\nrate_hz = 20\n", "c.toml")
            .barometer.iio.rate_hz == 20);
  fails("lidar.port = 9\n[lidar]\nmodel = \"VLP-16\"\n", "c.toml:2:");
  fails("lidar.port = 9\ndds.domain_id = 233\n",
        "c.toml:2:17: dds.domain_id: must be a whole number within -1 … 232 (got 233)");
}

TEST_CASE("Numbers are printed as plain decimals that read back to the same bits") {
  CHECK(number_text(2e5) == "200000");
  CHECK(number_text(3e-6) == "0.000003");
  CHECK(number_text(-0.35) == "-0.35");
  CHECK(number_text(0.0) == "0");
  CHECK(number_text(1e-30) == "1e-30");
  for (const double value : {1.0 / 3.0, 98'765.4, 1e-7 / 3.0, -2e14 / 7.0, 2.3e-308, 1.7e308}) {
    CHECK(std::stod(number_text(value)) == value);
  }
}

TEST_CASE("A configuration changed after loading is checked against the same table") {
  const auto refused = [](auto change, const char* words) {
    Config config;
    change(config);
    CAPTURE(words);
    CHECK_THROWS_WITH_AS(check_config(config, "command line"), doctest::Contains(words), ConfigError);
  };
  CHECK_NOTHROW(check_config(Config{}, "command line"));
  refused([](Config& c) { c.dds.domain_id = 233; },
          "command line: dds.domain_id: must be a whole number within -1 … 232 (got 233)");
  refused([](Config& c) { c.dds.domain_id = -2; }, "dds.domain_id");
  refused([](Config& c) { c.dds.network_interface = "eth0\"/><Bad"; },
          "dds.network_interface: must be empty, or names or addresses of network interfaces");
  refused([](Config& c) { c.dds.peers = "192.168.1.7, base.local"; },
          "dds.peers: must be empty, or up to 16");
  refused([](Config& c) { c.dds.peers = "192.168.1.7,"; }, "dds.peers");
  refused([](Config& c) { c.dds.frame_prefix = "/robot1/"; }, "dds.frame_prefix");
  refused([](Config& c) { c.dds.topics.pose = "/pose"; }, "dds.topics.pose");
  for (const char* name : {"1pose", "robot/1pose", "a//b", "a__b", "~/pose", "{x}", ""}) {
    refused([name](Config& c) { c.dds.topics.pose = name; }, "dds.topics.pose: must be a ROS name");
    if (*name != '\0') refused([name](Config& c) { c.dds.ros_namespace = name; }, "dds.ros_namespace");
  }
  refused([](Config& c) { c.dds.node_name = "a/b"; }, "dds.node_name");
  refused([](Config& c) { c.dds.topics.pose = "odom"; }, "dds.topics.pose: must differ from dds.topics.odom");
  refused([](Config& c) { c.dds.ros_namespace = "/robot"; }, "dds.ros_namespace");
  refused([](Config& c) { c.dds.map_frame = ""; }, "dds.map_frame");
  refused([](Config& c) { c.dds.base_station = ""; }, "dds.base_station");
  refused([](Config& c) { c.dds.second_base_station = "base"; }, "dds.second_base_station");
  refused([](Config& c) { c.dds.odom_rate_hz = std::numeric_limits<double>::quiet_NaN(); },
          "dds.odom_rate_hz");
  refused([](Config& c) { c.dds.ros_gid_bytes = 20; }, "dds.ros_gid_bytes: must be one of 16, 24 (got 20)");
  refused([](Config& c) { c.dds.propagator.slew_time_s = 0.0; }, "dds.propagator.slew_time_s");
  refused([](Config& c) { c.realtime.map_cpus = {-1}; }, "realtime.map_cpus");
  refused([](Config& c) { c.lidar.mount.xyz_m.z() = 1e9; }, "lidar.xyz_m");
}

TEST_CASE("An unknown key is an error that names the nearest one") {
  fails("[registration]\nmax_iteration = 3\n",
        "c.toml:2:17: registration.max_iteration: unknown key; did you mean registration.max_iterations?");
  fails("[lidarr]\nport = 3\n", "unknown key");
  fails("cell_m = 0.3\n", "did you mean map.cell_m?");
  fails("[dds.propagator]\nzzzzzzzzzzzzzzz = 3\n", "unknown key");
}

TEST_CASE("A file that is not a configuration is refused with the reason; an empty one gives the defaults") {
  fails("[lidar\n", "c.toml:1:");
  fails("a = 1\na = 2\n", "c.toml:2:");
  CHECK_THROWS_WITH_AS(load_config("/"), doctest::Contains("is a folder"), ConfigError);
  CHECK_THROWS_WITH_AS(load_config("/nonexistent/x.toml"), doctest::Contains("no such file"), ConfigError);
  CHECK(show_config(parse_config("", "c.toml")) == show_config(Config{}));
}

TEST_CASE("An integer is accepted for a floating-point setting") {
  CHECK(parse_config("[map]\ncell_m = 1\n", "c.toml").map.cell_m == 1.0);
}

}  // namespace isobar::test::test_config

// SPDX-License-Identifier: BSD-3-Clause
#include "tools/import/import_plan.hpp"

#include "core/errors.hpp"
#include "core/printable_text.hpp"
#include "tools/import/lidar_choice.hpp"
#include "tools/import/topic_choice.hpp"
#include "tools/import/topic_clocks.hpp"
#include "tools/import/topic_mounts.hpp"
#include "tools/import/topic_preferences.hpp"
#include "tools/import/unit_guess.hpp"

namespace isobar::tools {
namespace {

const char* no_kind(TopicKind kind) {
  switch (kind) {
    case TopicKind::kFrames:
      return "mounts, if they lead to sensors that are used";
    case TopicKind::kText:
      return "nothing: text";
    case TopicKind::kOther:
      return "nothing: a type that is not read";
    default:
      return "nothing: not needed";
  }
}

/// The plan under construction.
class Planner {
 public:
  Planner(const TopicSurvey& survey, const ImportRequest& request, ImportReport& report)
      : survey_(survey), request_(request), report_(report), becomes_(survey.topics.size()) {}

  ImportPlan make() {
    ask([this] { choose_lidar(survey_, request_, plan_, becomes_, report_.notes); });
    ask_of_imu([this] { choose_imu(); });
    ask([this] { choose_pressures(); });
    ask([this] { choose_motion(); });
    ask_of_imu([this] { place_sensors(survey_, request_, plan_, report_.notes); });
    if (!questions_.empty()) throw UsageError(questions_);
    align_clocks(survey_, plan_, report_.notes);
    fill_rows();
    return std::move(plan_);
  }

 private:
  const TopicFindings& at(std::size_t index) const { return survey_.topics[index]; }

  /// Collects what a person must answer, so that all is asked at once.
  template <typename Choose>
  void ask(const Choose& choose) {
    try {
      choose();
    } catch (const UsageError& question) {
      questions_ += (questions_.empty() ? "" : "\n") + std::string(question.what());
    }
  }
  /// The same of an IMU that nobody named; a run goes without it where nobody is asked.
  template <typename Choose>
  void ask_of_imu(const Choose& choose) {
    const std::size_t notes = report_.notes.size();
    try {
      choose();
    } catch (const UsageError& question) {
      if (!request_.asks_nothing || !request_.imu.empty() || !plan_.manifest.lidar) return ask(choose);
      if (plan_.imu) becomes_[plan_.imu->index] = "nothing: its mount is not known";
      plan_.imu.reset();
      plan_.manifest.imu.reset();
      report_.notes.resize(notes);
      report_.notes.push_back("imu: left out: " + std::string(question.what()));
      place_sensors(survey_, request_, plan_, report_.notes);
    }
  }

  void choose_imu() {
    const auto is_imu = [](const TopicFindings& topic) { return topic.kind == TopicKind::kImu; };
    const auto imus = likely_imus(survey_, request_, plan_.lidar ? &at(plan_.lidar->index) : nullptr);
    const auto index = choose_topic(survey_, request_.imu, "--imu", is_imu,
                                    [&](const TopicFindings& topic) { return is_among(topic, imus); });
    if (!index) return;
    const TopicFindings& topic = at(*index);
    const UnitGuess accel = guess_accel_unit(request_.accel_unit, topic.first_values);
    const UnitGuess gyro =
        guess_gyro_unit(request_.gyro_unit, topic.second_values, topic.attitude_turn_rad, topic.rate_turn);
    plan_.imu = PlannedTopic{*index};
    plan_.manifest.imu = recording::SensorEntry{"imu.csv", {}};
    plan_.accel_scale = accel.scale;
    plan_.gyro_scale = gyro.scale;
    plan_.keeps_attitude = topic.attitude_turn_rad > 0.0;
    becomes_[*index] = "imu.csv: " + accel.text + "; " + gyro.text;
    if (!accel.is_certain) {
      report_.notes.push_back(printable(topic.channel.topic) +
                              ": the unit of its acceleration is not known: " + accel.text +
                              "; --accel-unit m/s2, g or mg says it, --imu none leaves the IMU out");
    }
  }

  void choose_pressures() {
    const auto is_pressure = [](const TopicFindings& topic) { return topic.kind == TopicKind::kPressure; };
    const auto barometers = likely_barometers(survey_);
    const auto is_of_base = [&](const TopicFindings& topic) {
      return is_among(topic, barometers) && names_one_of(topic.channel.topic, {"base", "station"}) &&
             !names_one_of(topic.channel.topic, {"base_link"});
    };
    const auto base = choose_topic(survey_, request_.base_pressure, "--base-pressure", is_pressure,
                                   [&](const TopicFindings& topic) {
                                     return is_of_base(topic) && topic.channel.topic != request_.pressure;
                                   });
    const auto robot =
        choose_topic(survey_, request_.pressure, "--pressure", is_pressure, [&](const TopicFindings& topic) {
          return is_among(topic, barometers) && !(base && &topic == &at(*base)) && !is_of_base(topic);
        });
    if (robot) {
      plan_.pressure = PlannedTopic{*robot};
      plan_.manifest.barometer = recording::SensorEntry{"barometer.csv", {}};
      plan_.pressure_scale = use_pressure(*robot, "barometer.csv: ");
      find_temperature(at(*robot));
    }
    if (base) {
      plan_.base_pressure = PlannedTopic{*base};
      plan_.manifest.base_barometer = recording::SensorEntry{"base_barometer.csv", {}, true};
      plan_.base_pressure_scale = use_pressure(*base, "base_barometer.csv: ");
    }
  }

  double use_pressure(std::size_t index, const char* file) {
    const UnitGuess unit = guess_pressure_unit(request_.pressure_unit, at(index).first_values);
    becomes_[index] = file + unit.text;
    if (!unit.is_certain) {
      throw UsageError("--pressure-unit: " + printable(at(index).channel.topic) + ": " + unit.text +
                       "; say --pressure-unit Pa, hPa or kPa, or --pressure none");
    }
    return unit.scale;
  }

  /// The thermometer of the same frame, or the only one.
  void find_temperature(const TopicFindings& pressure) {
    std::optional<std::size_t> found;
    std::size_t thermometers = 0;
    for (std::size_t i = 0; i < survey_.topics.size(); ++i) {
      if (at(i).kind != TopicKind::kTemperature || !at(i).is_usable()) continue;
      ++thermometers;
      if (at(i).frame_id == pressure.frame_id) found = i;
      if (!found && thermometers == 1) found = i;
    }
    if (!found || (thermometers > 1 && at(*found).frame_id != pressure.frame_id)) return;
    plan_.temperature = PlannedTopic{*found};
    becomes_[*found] = "barometer.csv: its temperature";
  }

  void choose_motion() {
    const auto has_twist = [](const TopicFindings& topic) {
      return topic.kind == TopicKind::kTwist || (topic.kind == TopicKind::kOdometry && topic.has_twist);
    };
    const auto wheel =
        choose_topic(survey_, request_.wheel, "--wheel", has_twist, [&](const TopicFindings& topic) {
          const std::string& name = topic.channel.topic;
          const bool is_other =
              names_one_of(name, {"lidar", "laser", "lio", "vio", "visual", "camera", "gps", "gnss", "truth",
                                  "map", "filter", "fused", "loam", "slam", "icp", "cmd", "imu"});
          return has_twist(topic) && !is_other && names_one_of(name, {"wheel", "odom", "encoder"});
        });
    if (wheel) {
      plan_.wheel = PlannedTopic{*wheel};
      plan_.manifest.wheel = recording::SensorEntry{"wheel.csv", {}};
      becomes_[*wheel] = "wheel.csv: m/s, rad/s";
    }
    const auto has_pose = [](const TopicFindings& topic) {
      return topic.kind == TopicKind::kPose || topic.kind == TopicKind::kOdometry;
    };
    const auto reference =
        choose_topic(survey_, request_.reference, "--reference", has_pose, [&](const TopicFindings& topic) {
          return has_pose(topic) &&
                 names_one_of(topic.channel.topic,
                              {"ground_truth", "groundtruth", "truth", "vicon", "mocap", "optitrack", "vrpn",
                               "qualisys", "leica", "/gt", "_gt", "reference"});
        });
    if (!reference) return;
    plan_.reference = PlannedTopic{*reference};
    plan_.manifest.reference = recording::SensorEntry{"reference.tum", {}};
    becomes_[*reference] = "reference.tum";
    const std::string& child = at(*reference).child_frame;
    if (child.empty() || child == request_.base_frame) return;
    if (const auto T = survey_.frames.find(child, request_.base_frame)) {
      plan_.T_child_base = *T;
    } else {
      report_.notes.push_back("reference: poses of " + printable(child) +
                              " are taken for those of base_link");
    }
  }

  void fill_rows() {
    for (std::size_t i = 0; i < survey_.topics.size(); ++i) {
      const TopicFindings& topic = at(i);
      std::string becomes = becomes_[i].empty() ? no_kind(topic.kind) : becomes_[i];
      if (topic.kind != TopicKind::kOther && topic.broken > 0) {
        becomes += "; " + std::to_string(topic.broken) + " messages left out, the first " + topic.first_rule;
      }
      if (topic.channel.encoding == imports::Encoding::kOther) {
        becomes = "nothing: encoding " + printable(topic.channel.encoding_name) + " is not read";
      }
      report_.rows.push_back(
          {topic.channel.topic, topic.channel.type, topic.messages, topic.rate_hz(), becomes});
    }
  }

  const TopicSurvey& survey_;
  const ImportRequest& request_;
  ImportReport& report_;
  ImportPlan plan_;
  std::vector<std::string> becomes_;  // by topic
  std::string questions_;
};

}  // namespace

ImportPlan plan_import(const TopicSurvey& survey, const ImportRequest& request, ImportReport& report) {
  report.container = survey.container;
  if (survey.damage.count > 0) {
    report.notes.push_back(
        "damaged: " + survey.damage.first_message +
        (survey.damage.count > 1 ? " (and " + std::to_string(survey.damage.count - 1) + " more)" : ""));
  }
  return Planner(survey, request, report).make();
}

}  // namespace isobar::tools

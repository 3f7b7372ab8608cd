// SPDX-License-Identifier: BSD-3-Clause
// `isobar evaluate`: figures of one or more estimates against a reference.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "core/geometry.hpp"
#include "run/evaluation/second_session.hpp"
#include "tools/commands.hpp"
#include "tools/number_option.hpp"
#include "tools/output_option.hpp"
#include "tools/report/figures_json.hpp"
#include "tools/report/report.hpp"
#include "tools/report/terminal_table.hpp"
#include "tools/subcommand.hpp"
#include "tools/typed_words.hpp"

namespace isobar::tools {

namespace {

struct EvaluateArguments {
  std::string reference;
  std::vector<std::string> estimates;
  std::string segments;
  std::string names;  ///< separated by commas
  std::string title;
  std::string report;
  std::string json;
  std::string alignment = "start";
  std::optional<double> max_gap_s;
  bool corrected = false;
  std::vector<std::string> first_session;  ///< its reference and its run
};

std::vector<evaluation::EstimateSource> sources_of(const EvaluateArguments& arguments) {
  const std::vector<std::string> names = comma_separated(arguments.names);
  if (!names.empty() && names.size() != arguments.estimates.size()) {
    throw UsageError("--names: " + std::to_string(names.size()) + " names for " +
                     std::to_string(arguments.estimates.size()) + " estimates");
  }
  std::vector<evaluation::EstimateSource> sources;
  for (std::size_t i = 0; i < arguments.estimates.size(); ++i) {
    sources.push_back({names.empty() ? "" : names[i], arguments.estimates[i]});
  }
  if (arguments.corrected) evaluation::add_corrected(sources);
  return sources;
}

evaluation::Alignment alignment_of(const std::string& name) {
  if (name == "yaw") return evaluation::Alignment::kYawTranslation;
  if (name == "rigid") return evaluation::Alignment::kRigid;
  return evaluation::Alignment::kStart;
}

/// Errors in the map frame of another session: no alignment of their own.
void print_in_first_frame(const std::vector<std::string>& first_session,
                          const evaluation::EvaluatedRun& run) {
  const evaluation::ReferenceData first = evaluation::load_reference(first_session[0]);
  const evaluation::Trajectory first_run = evaluation::read_estimate(first_session[1]);
  std::printf("In the frame of %s, without an alignment of their own\n", first_session[1].c_str());
  std::printf("poses  position rms     max   yaw rms     max\n");
  for (const evaluation::EvaluatedMethod& method : run.methods) {
    const auto error = evaluation::second_session_error(
        {first.trajectory, first_run}, {run.reference.trajectory, evaluation::read_estimate(method.source)});
    std::printf("%5zu       %.3f m  %.3f m  %.2f deg  %.2f deg  %s\n", error.poses, error.position_rms_m,
                error.position_max_m, error.yaw_rms_rad / kRadPerDeg, error.yaw_max_rad / kRadPerDeg,
                method.name.c_str());
  }
  std::printf("\n");
}

void run_evaluate(const EvaluateArguments& arguments, const std::string& command) {
  require_path(arguments.reference, "a .tum file, or a recording with reference.tum");
  for (const auto& estimate : arguments.estimates)
    require_path(estimate, "a .tum file, or the folder of a run with trajectory.tum");
  const std::vector<evaluation::EstimateSource> sources = sources_of(arguments);
  std::optional<std::filesystem::path> segments;
  if (!arguments.segments.empty()) segments = arguments.segments;
  evaluation::EvaluationOptions options;
  options.ate_alignment = alignment_of(arguments.alignment);
  options.max_gap_s = arguments.max_gap_s;
  report::ReportInput input;
  input.run = evaluation::evaluate_methods(evaluation::load_reference(arguments.reference, segments), sources,
                                           options);
  input.title = arguments.title.empty() ? "Isobar evaluation" : arguments.title;
  input.command = command;
  report::print_table(stdout, input.run);
  std::printf("\n");
  if (!arguments.first_session.empty()) print_in_first_frame(arguments.first_session, input.run);
  if (!arguments.json.empty()) write_output(arguments.json, report::figures_json(input.run));
  if (!arguments.report.empty()) write_output(arguments.report, report::render_report(input));
}

}  // namespace

void add_evaluate_command(CLI::App& app) {
  const auto [command, options] = add_subcommand<EvaluateArguments>(
      app, "evaluate", "Compare estimates with a reference: figures and a report", run_evaluate);
  command.add_option("REFERENCE", options.reference, "a .tum file, or a recording with reference.tum")
      ->required();
  command
      .add_option("ESTIMATE", options.estimates,
                  "one or more .tum files or folders of a run (with trajectory.tum)")
      ->required();
  command.add_option("--segments", options.segments, "segments.csv to use instead of the recording's");
  command.add_option("--names", options.names, "names of the estimates, separated by commas");
  command
      .add_option(
          "--align", options.alignment,
          "alignment for the absolute error: first pose, best yaw and translation, or best rotation and "
          "translation")
      ->check(one_of({"start", "yaw", "rigid"}))
      ->capture_default_str()
      ->option_text("start|yaw|rigid");
  command
      .add_option(
          "--max-gap", options.max_gap_s,
          "longest gap between two poses that is bridged [s] (0.5, or 1.5 usual intervals where these are "
          "longer)")
      ->check(number_within(0.001, 3600.0))
      ->option_text("SECONDS");
  command.add_flag("--corrected", options.corrected,
                   "evaluate the trajectory of each run as its loops correct it as well");
  command
      .add_option("--first-session", options.first_session,
                  "reference and run of the session whose map was used: errors in its frame as well")
      ->expected(2)
      ->option_text("REFERENCE RUN");
  command.add_option("--title", options.title, "headline of the report");
  command.add_option("--report", options.report, "HTML file for the report; it opens without a network")
      ->check(written_as({".html", ".htm"}));
  command.add_option("--json", options.json, "JSON file for all figures")->check(written_as({".json"}));
}

}  // namespace isobar::tools

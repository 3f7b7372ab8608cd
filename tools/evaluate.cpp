// SPDX-License-Identifier: BSD-3-Clause
// `isobar evaluate`: figures of one or more estimates against a reference.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "run/files/text_file.hpp"
#include "tools/commands.hpp"
#include "tools/report/figures_json.hpp"
#include "tools/report/report.hpp"
#include "tools/report/terminal_table.hpp"
#include "tools/typed_command.hpp"

namespace isobar::tools {

namespace {

struct EvaluateArguments {
  std::string reference;
  std::vector<std::string> estimates;
  std::string segments;
  std::string names;  ///< separated by commas
  std::string title;
  std::string report;
  std::string picture;
  std::string json;
  evaluation::Alignment alignment = evaluation::Alignment::kStart;
};

std::vector<std::string> split_names(const std::string& text) {
  std::vector<std::string> names;
  std::istringstream stream(text);
  for (std::string name; std::getline(stream, name, ',');) names.push_back(name);
  return names;
}

std::vector<evaluation::EstimateSource> sources_of(const EvaluateArguments& arguments) {
  const std::vector<std::string> names = split_names(arguments.names);
  if (!names.empty() && names.size() != arguments.estimates.size()) {
    throw UsageError("--names: " + std::to_string(names.size()) + " names for " +
                     std::to_string(arguments.estimates.size()) + " estimates");
  }
  std::vector<evaluation::EstimateSource> sources;
  for (std::size_t i = 0; i < arguments.estimates.size(); ++i) {
    sources.push_back({names.empty() ? "" : names[i], arguments.estimates[i]});
  }
  return sources;
}

/// The command line again, for the report: what a person would type.
std::string typed_command(const EvaluateArguments& arguments) {
  std::string command = "isobar evaluate " + shell_quoted(arguments.reference);
  for (const std::string& estimate : arguments.estimates) command += " " + shell_quoted(estimate);
  if (!arguments.segments.empty()) command += " --segments " + shell_quoted(arguments.segments);
  if (!arguments.names.empty()) command += " --names " + shell_quoted(arguments.names);
  if (arguments.alignment == evaluation::Alignment::kYawTranslation) command += " --align yaw";
  if (arguments.alignment == evaluation::Alignment::kRigid) command += " --align rigid";
  if (!arguments.title.empty()) command += " --title " + shell_quoted(arguments.title);
  return command + " --report " + shell_quoted(arguments.report.empty() ? "report.html" : arguments.report);
}

void run_evaluate(const EvaluateArguments& arguments) {
  const std::vector<evaluation::EstimateSource> sources = sources_of(arguments);
  std::optional<std::filesystem::path> segments;
  if (!arguments.segments.empty()) segments = arguments.segments;
  evaluation::EvaluationOptions options;
  options.ate_alignment = arguments.alignment;
  report::ReportInput input;
  input.run = evaluation::evaluate_methods(evaluation::load_reference(arguments.reference, segments), sources,
                                           options);
  input.title = arguments.title.empty() ? "Isobar evaluation" : arguments.title;
  input.command = typed_command(arguments);
  report::print_table(stdout, input.run);
  if (!arguments.json.empty()) files::write_text_file(arguments.json, report::figures_json(input.run));
  if (!arguments.picture.empty())
    files::write_text_file(arguments.picture, report::render_overview_svg(input));
  if (arguments.report.empty()) return;
  report::write_report(arguments.report, input);
  std::printf("\nreport: %s\n", arguments.report.c_str());
}

}  // namespace

void add_evaluate_command(CLI::App& app) {
  const std::map<std::string, evaluation::Alignment> alignments{
      {"start", evaluation::Alignment::kStart},
      {"yaw", evaluation::Alignment::kYawTranslation},
      {"rigid", evaluation::Alignment::kRigid}};
  auto arguments = std::make_shared<EvaluateArguments>();
  CLI::App* command =
      app.add_subcommand("evaluate", "Compare estimates with a reference: figures and a report");
  command->add_option("REFERENCE", arguments->reference, "A .tum file, or a recording with reference.tum")
      ->required();
  command->add_option("ESTIMATE", arguments->estimates, "A .tum file, or the folder of a replay; one or more")
      ->required();
  command->add_option("--segments", arguments->segments, "segments.csv to use instead of the recording's");
  command->add_option("--names", arguments->names, "Names of the estimates, separated by commas");
  command
      ->add_option(
          "--align", arguments->alignment,
          "What the absolute error is taken after: 'start' (first pose), 'yaw' or 'rigid' (best fit)")
      ->transform(CLI::CheckedTransformer(alignments))
      ->option_text("start|yaw|rigid");
  command->add_option("--title", arguments->title, "Headline of the report");
  command->add_option("--report", arguments->report, "Write an HTML report that opens without a network");
  command->add_option("--picture", arguments->picture, "Write the overview picture alone, as SVG");
  command->add_option("--json", arguments->json, "Write all figures as JSON");
  command->callback([arguments] { run_evaluate(*arguments); });
}

}  // namespace isobar::tools

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <prometheus/collectable.h>
#include <prometheus/metric_family.h>

#include <mutex>
#include <optional>
#include <vector>

#include "ipc/topics.hpp"

namespace isobar::tools {

/// Metrics of a health report, with units in their names as Prometheus wants them. Without a report (isobard
/// does not run) only isobar_up, 0; with one older than kOldReportS (it hangs) that and its age. Ages are as of now.
/// Figures that do not exist are left out.
[[nodiscard]] std::vector<prometheus::MetricFamily> metrics_of(const ipc::HealthReport* report, double age_s);

/// The newest report, for the threads of the HTTP server.
class MetricsSource final : public prometheus::Collectable {
 public:
  void put(const ipc::HealthReport& report);
  void put_absence();
  [[nodiscard]] std::vector<prometheus::MetricFamily> Collect() const override;

 private:
  mutable std::mutex mutex_;
  std::optional<ipc::HealthReport> report_;
};

}  // namespace isobar::tools

// SPDX-License-Identifier: BSD-3-Clause
// Received DDS messages as lines on standard output.
#pragma once

#include "ipc/dds/topics.hpp"

namespace isobar::tools {

/// One line, or one for each transform or each status that is not ok. `topic` begins the line.
void print_line(const char* topic, const dds::PoseMessage& message);
void print_line(const char* topic, const dds::OdometryMessage& message);
void print_line(const char* topic, const dds::AltitudeMessage& message);
void print_line(const char* topic, const dds::TfMessage& message);
void print_line(const char* topic, const dds::GridMessage& message);
void print_line(const char* topic, const dds::CloudMessage& message);
void print_line(const char* topic, const dds::PressureMessage& message);
void print_line(const char* topic, const dds::TemperatureMessage& message);
void print_line(const char* topic, const dds::ImuMessage& message);
void print_line(const char* topic, const dds::TwistMessage& message);
void print_line(const char* topic, const dds::Int32Message& message);
void print_line(const char* topic, const dds::StringMessage& message);
void print_line(const char* topic, const dds::DiagnosticsMessage& message);

}  // namespace isobar::tools

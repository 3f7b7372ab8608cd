// SPDX-License-Identifier: BSD-3-Clause
// Names of the estimate's enumerators on every wire: files, topics, command line, configuration, log.
#pragma once

#include "core/estimates.hpp"
#include "core/name_table.hpp"

namespace isobar {

inline constexpr NameTable<Method, 7> kMethodNames{{{
    {Method::k6Dof, "6dof"},
    {Method::k4Dof, "4dof"},
    {Method::k3Dof, "3dof"},
    {Method::k6DofAltitude, "6dof-altitude"},
    {Method::k4DofAltitude, "4dof-altitude"},
    {Method::kOdometry, "odometry"},
    {Method::kAdaptive, "adaptive"},
}}};

inline constexpr NameTable<PoseMode, 3> kPoseModeNames{{{
    {PoseMode::kRegistered, "registered"},
    {PoseMode::kPriorOnly, "prior"},
    {PoseMode::kInitializing, "initializing"},
}}};

inline constexpr NameTable<LostReason, 4> kLostReasonTexts{{{
    {LostReason::kNone, "no"},
    {LostReason::kTurn, "the scans turn against the gyro"},
    {LostReason::kTilt, "the scans are tilted against gravity"},
    {LostReason::kMovingGround, "the ground moves, and scans of a cabin cannot tell its height"},
}}};

inline constexpr NameTable<HeightSource, 4> kHeightSourceNames{{{
    {HeightSource::kDifferential, "differential"},
    {HeightSource::kSingleBarometer, "single_barometer"},
    {HeightSource::kHeld, "held"},
    {HeightSource::kNone, "none"},
}}};

inline constexpr NameTable<DriftSuspect, 4> kDriftSuspectNames{{{
    {DriftSuspect::kNone, "none"},
    {DriftSuspect::kRobot, "robot"},
    {DriftSuspect::kBase, "base_station"},
    {DriftSuspect::kUnknown, "robot_or_base_station"},
}}};

inline constexpr NameTable<Holder, 6> kHolderNames{{{
    {Holder::kScan, "scan"},
    {Holder::kGravityDirection, "gravity"},
    {Holder::kGyro, "gyro"},
    {Holder::kWheels, "wheels"},
    {Holder::kAltimeter, "altimeter"},
    {Holder::kMotion, "motion"},
}}};

}  // namespace isobar

// Recursive update of a calibrated motion model while the robot is in use: an extended Kalman filter over the
// parameters, one sequence at a time, in information form (Thrun, Burgard, Fox: "Probabilistic Robotics", 2005,
// section 3.5), with exponential forgetting and resetting (Salgado, Goodwin, Middleton: "Modified least squares
// algorithm incorporating exponential resetting and forgetting", International Journal of Control 47, 1988): before
// every sequence
//
//   information <- forgetting * information + (1 - forgetting) * information of the prior,
//
// so that what is not excited is forgotten no further than to the prior of the calibration, and the covariance cannot
// grow without bound. The estimate itself is left where it is. Cost: as one Jacobian of fit_model for the sequence.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "surefoot/core/compiled.hpp"
#include "surefoot/motion/any_motion_model.hpp"
#include "surefoot/motion/fit/fit_model.hpp"
#include "surefoot/motion/noise.hpp"
#include "surefoot/motion/walk_sequence.hpp"

namespace surefoot {

/// The information about the parameters before a calibration has seen its first sequence: they lie about their defaults
/// by `prior` widths of their ranges.
Eigen::MatrixXd prior_information(const AnyMotionModel& model, double prior = ModelFitOptions().prior);

/// A calibrated model and how well it is known, now.
struct MotionTracker {
  AnyMotionModel model;
  Eigen::MatrixXd information = prior_information(model);  // inverse of the covariance of the parameters
  MotionNoise noise = {};                                  // of the walk
  PoseAccuracy accuracy = {};                              // of the measured poses
  double forgetting = 0.98;                                // factor per sequence, in (0, 1]; 1: nothing is forgotten
  Eigen::MatrixXd floor = prior_information(model);        // the information that is never forgotten

  Eigen::MatrixXd covariance() const;
  Eigen::VectorXd standard_errors() const { return roots_of_diagonal<Eigen::Dynamic>(covariance()); }
};

/// Continues a calibration: its model, covariance and noise, made with these options. Throws MotionError if the
/// covariance is none.
MotionTracker track(const AnyMotionModel& model, const Eigen::MatrixXd& covariance, const MotionNoise& noise,
                    const ModelFitOptions& options = {});

/// The information in a sequence about the parameters, to first order about those of the tracker: the squared whitened
/// innovations are rest - 2 offset^T d + d^T information d for parameters moved by d.
struct InformationUpdate {
  Eigen::VectorXd at;           // the parameters it was worked out about
  Eigen::MatrixXd information;  // Jacobian^T Jacobian
  Eigen::VectorXd offset;       // Jacobian^T innovations
  double rest = 0;              // innovations^T innovations
  Eigen::Index count = 0;       // of innovations
};

/// How surprising a sequence was.
struct Surprise {
  double squared = 0;         // normalised innovation squared, the uncertainty of the parameters included
  Eigen::Index freedoms = 0;  // its mean, for a robot that walks as calibrated (it is a chi-square of as many)

  /// The same as a standard normal number: 3 is rare, 5 hardly ever chance (Wilson and Hilferty 1931).
  double deviations() const {
    const double variance = 2.0 / (9.0 * static_cast<double>(freedoms));
    return (std::cbrt(squared / static_cast<double>(freedoms)) - (1 - variance)) / std::sqrt(variance);
  }
};

/// Throws MotionError if the sequence cannot be used.
InformationUpdate linearize(const MotionTracker& tracker, const WalkSequence& sequence);

/// The step in time before the next sequence.
void forget(MotionTracker& tracker);

/// How surprising a sequence is, for the tracker that it was linearized about.
Surprise surprise(const MotionTracker& tracker, const InformationUpdate& update);

/// Takes over the information of a sequence. It may have been linearized about parameters nearby.
void learn(MotionTracker& tracker, const InformationUpdate& update);

/// Updates the tracker by one sequence; returns how surprising it was. The tracker should have been calibrated: what is
/// linear about a model that is far off costs some half of a standard error. Nothing is held back: whoever mistrusts a
/// sequence asks `surprise(tracker, linearize(tracker, sequence))` first. Throws MotionError if it cannot be used; the
/// tracker is then as it was.
Surprise update(MotionTracker& tracker, const WalkSequence& sequence);

}  // namespace surefoot

#ifndef SUREFOOT_COMPILED
#include "surefoot/motion/monitor/recursive_update.ipp"
#endif

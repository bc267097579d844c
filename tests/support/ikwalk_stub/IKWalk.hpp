// A stand-in for the header of Rhoban/IKWalk with the same names, so that the adapter is compiled by every build. It
// does not walk: the joints echo what came in.
#pragma once

namespace Rhoban {

struct IKWalkParameters {
  double distHipToKnee, distKneeToAnkle, distAnkleToGround, distFeetLateral;
  double freq, enabledGain, supportPhaseRatio, footYOffset, stepGain, riseGain, turnGain, lateralGain, trunkZOffset;
  double swingGain, swingRollGain, swingPhase, stepUpVel, stepDownVel, riseUpVel, riseDownVel, swingPause, swingVel;
  double trunkXOffset, trunkYOffset, trunkPitch, trunkRoll;
  double extraLeftX, extraLeftY, extraLeftZ, extraRightX, extraRightY, extraRightZ;
  double extraLeftYaw, extraLeftPitch, extraLeftRoll, extraRightYaw, extraRightPitch, extraRightRoll;
};

struct IKWalkOutputs {
  double left_hip_yaw, left_hip_pitch, left_hip_roll, left_knee, left_ankle_pitch, left_ankle_roll;
  double right_hip_yaw, right_hip_pitch, right_hip_roll, right_knee, right_ankle_pitch, right_ankle_roll;
};

class IKWalk {
 public:
  /// Not reachable, but with a phase and outputs all the same, for steps above 1 m; no number for steps below -1 m.
  static bool walk(const IKWalkParameters& p, double dt, double& phase, IKWalkOutputs& out) {
    phase += dt * p.freq;
    if (phase >= 1.0) phase -= 1.0;
    const double zero = p.stepGain < -1 ? 0.0 : 1.0;
    out = {p.stepGain, p.lateralGain, p.turnGain,   p.enabledGain,    p.distHipToKnee,     p.riseGain,
           p.freq,     p.trunkPitch,  p.extraLeftX, p.extraRightRoll, p.supportPhaseRatio, (zero - 1.0) / zero};
    return !(p.stepGain > 1);
  }
};

}  // namespace Rhoban

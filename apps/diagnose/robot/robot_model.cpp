#include "robot_model.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <cstring>
#include <functional>
#include <regex>

#include "../names.hpp"
#include "surefoot/core/binary.hpp"
#include "surefoot/core/error.hpp"
#include "xml_text.hpp"

namespace diagnose_robot {
namespace {

using surefoot::DiagnoseError;

// MuJoCo ends the program on errors unless told otherwise.
void throw_error(const char* message) { throw DiagnoseError(std::string("MuJoCo: ") + message); }
void ignore_warning(const char*) {}

std::string one_line(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  }
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

// MuJoCo's reader (2.2) fails on some damaged files, such as a URDF with a letter in a number: a child process tries
// first. What it died of, or nothing.
std::string what_ends_it(const std::function<void()>& load) {
  constexpr unsigned longest = 60;  // [s]; meshes of a large robot take a few
  const pid_t child = fork();
  if (child == 0) {
    for (const int fault : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) std::signal(fault, SIG_DFL);  // not handled here
    alarm(longest);
    load();
    _exit(0);
  }
  int status = 0;
  if (child < 0 || waitpid(child, &status, 0) != child || status == 0) return "";
  const std::string reason = WIFSIGNALED(status) ? strsignal(WTERMSIG(status)) : "it gave up";
  return "its reader fails on this file (" + reason + "); look for numbers and elements that are damaged";
}

// What to do about a file that MuJoCo's reader refuses: its own words, without those of its XML parser.
std::string refusal(const std::string& complaint) {
  std::smatch line;
  if (complaint.find("XML parse error") != std::string::npos &&
      std::regex_search(complaint, line, std::regex("[Ll]ine number=([0-9]+)"))) {
    return "the XML breaks off in line " + line[1].str() + ": close the element or the quotes there";
  }
  const bool of_mesh = std::regex_search(complaint, std::regex("mesh|\\.stl|\\.obj|inertia", std::regex::icase));
  return "MuJoCo cannot load it: " + complaint +
         (of_mesh ? "; mend the file, or give each link an inertial element if it is a mesh that is missing"
                  : "; mend the file there");
}

void refuse_other_files(const RobotModel& robot) {
  const std::size_t begin = robot.text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (begin == std::string::npos)
    throw DiagnoseError(robot.file + ": the file is empty; a robot in MJCF or URDF is wanted");
  const bool known = robot.text.find("<mujoco") != std::string::npos || robot.text.find("<robot") != std::string::npos;
  if (robot.text[begin] == '<' && known) return;
  throw DiagnoseError(robot.file +
                      ": neither MJCF (<mujoco>) nor URDF (<robot>); give the robot's model first, then the log");
}

std::string name_of(const mjModel* m, int type, int id) {
  const char* name = mj_id2name(m, type, id);
  return name != nullptr ? name : "";
}

// Limits and gains of the actuator that drives the joint.
void read_actuator(const mjModel* m, ModelJoint& joint) {
  for (int a = 0; a < m->nu; ++a) {
    if (m->actuator_trntype[a] != mjTRN_JOINT || m->actuator_trnid[2 * a] != joint.id) continue;
    const double gear = std::abs(m->actuator_gear[6 * a]);
    const mjtNum* bias = m->actuator_biasprm + a * mjNBIAS;
    const double gain = m->actuator_gainprm[a * mjNGAIN];
    if (m->actuator_biastype[a] == mjBIAS_AFFINE && bias[1] != 0) {  // position servo
      joint.kp = gain * gear;
      joint.kd = -bias[2] * gear;
    } else if (m->actuator_ctrllimited[a] != 0) {
      joint.torque_limit = gear * std::abs(gain) * m->actuator_ctrlrange[2 * a + 1];
    }
    if (m->actuator_forcelimited[a] != 0) joint.torque_limit = gear * m->actuator_forcerange[2 * a + 1];
  }
}

// The far end of a link: the farthest point where something hangs on it, else the centre of mass doubled.
void find_tip(const mjModel* m, ModelJoint& joint) {
  double best = 0;
  const auto offer = [&](const mjtNum* at) {
    const double distance = std::hypot(at[0], at[1], at[2]);
    if (distance <= best) return;
    best = distance;
    std::copy_n(at, 3, joint.tip);
  };
  for (int s = 0; s < m->nsite; ++s) {
    if (m->site_bodyid[s] == joint.body) offer(m->site_pos + 3 * s);
  }
  for (int b = 1; b < m->nbody; ++b) {
    if (m->body_parentid[b] == joint.body) offer(m->body_pos + 3 * b);
  }
  if (best > 0) return;
  for (int i = 0; i < 3; ++i) joint.tip[i] = 2 * m->body_ipos[3 * joint.body + i];
}

std::vector<ModelJoint> joints_of(const mjModel* m, const std::string& text) {
  std::vector<ModelJoint> joints;
  for (int j = 0; j < m->njnt; ++j) {
    if (m->jnt_type[j] != mjJNT_HINGE && m->jnt_type[j] != mjJNT_SLIDE) continue;
    ModelJoint joint;
    joint.name = name_of(m, mjOBJ_JOINT, j);
    joint.id = j;
    joint.dof = m->jnt_dofadr[j];
    joint.position = m->jnt_qposadr[j];
    joint.body = m->jnt_bodyid[j];
    joint.slides = m->jnt_type[j] == mjJNT_SLIDE;
    if (m->jnt_limited[j] != 0) {
      joint.low = m->jnt_range[2 * j];
      joint.high = m->jnt_range[2 * j + 1];
    }
    joint.damping = m->dof_damping[joint.dof];
    joint.armature = m->dof_armature[joint.dof];
    joint.frictionloss = m->dof_frictionloss[joint.dof];
    joint.class_name = class_of_joint(text, joint.name);
    read_actuator(m, joint);
    find_tip(m, joint);
    joints.push_back(joint);
  }
  return joints;
}

}  // namespace

ModelPointer compile_model(const std::string& text, const std::filesystem::path& folder, bool urdf,
                           std::string& complaint) {
  mju_user_error = throw_error;
  mju_user_warning = ignore_warning;
  // From a file beside the model, so that what it includes is found; its text from memory.
  auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  const char* name = urdf ? "surefoot_robot.urdf" : "surefoot_robot.xml";
  std::array<char, 1000> error{};
  ModelPointer model;
  if (mj_makeEmptyFileVFS(files.get(), name, static_cast<int>(text.size())) == 0) {
    std::copy(text.begin(), text.end(), static_cast<char*>(files->filedata[mj_findFileVFS(files.get(), name)]));
    std::error_code none;
    const auto before = std::filesystem::current_path(none);
    if (!folder.empty()) std::filesystem::current_path(folder, none);
    const auto load = [&] { return mj_loadXML(name, files.get(), error.data(), static_cast<int>(error.size())); };
    const std::string failure = what_ends_it([&] {
      try {
        mj_deleteModel(load());
      } catch (const DiagnoseError&) {  // said when it is loaded here
      }
    });
    if (failure.empty()) {
      model.reset(load());
    } else {
      std::ranges::copy(failure, error.begin());
    }
    std::filesystem::current_path(before, none);
  }
  mj_deleteVFS(files.get());
  complaint = model ? "" : one_line(error.data());
  return model;
}

RobotModel load_robot(const std::filesystem::path& file) {
  RobotModel robot;
  robot.file = file.filename().string();
  const surefoot::Bytes bytes = surefoot::read_file(file);
  robot.text.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  refuse_other_files(robot);
  const bool urdf = is_urdf(robot.text);
  if (urdf) robot.text = without_elements(robot.text, {"visual", "collision"});
  std::string complaint, second;
  robot.model = compile_model(robot.text, file.parent_path(), urdf, complaint);
  // What is missing or cannot be, and does not matter here: pictures of links, and inertias of links that have none.
  const auto try_text = [&](const std::string& text, const std::string& remark) {
    if (robot.model || text == robot.text) return;
    robot.model = compile_model(text, file.parent_path(), urdf, second);
    if (!robot.model) return;
    robot.text = text;
    robot.remarks.push_back(robot.file + ": " + complaint + "; " + remark);
  };
  try_text(without_meshes(robot.text), "meshes were left out");
  try_text(with_possible_inertias(robot.text), "inertias that cannot be were made possible");
  try_text(with_possible_inertias(without_meshes(robot.text)),
           "meshes were left out and inertias that cannot be made possible");
  if (!robot.model) {
    throw DiagnoseError(robot.file + ": " + refusal(complaint));
  }
  const mjModel* m = robot.model.get();
  robot.name = m->names[0] != 0 ? m->names : robot.file;
  for (int j = 0; j < m->njnt; ++j) robot.floating_base = robot.floating_base || m->jnt_type[j] == mjJNT_FREE;
  robot.joints = joints_of(m, robot.text);
  if (robot.joints.empty()) {
    throw DiagnoseError(robot.file + ": the model has no hinge or slide joint; nothing can be diagnosed");
  }
  return robot;
}

}  // namespace diagnose_robot

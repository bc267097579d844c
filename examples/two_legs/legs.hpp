// A model of MuJoCo with its state, of which the programs beside take care.
#pragma once

#include <mujoco/mujoco.h>

#include <array>
#include <memory>
#include <stdexcept>
#include <string>

namespace two_legs {

struct Simulation {
  std::unique_ptr<mjModel, void (*)(mjModel*)> model;
  std::unique_ptr<mjData, void (*)(mjData*)> data;

  explicit Simulation(const std::string& file)
      : model(load(file), mj_deleteModel), data(mj_makeData(model.get()), mj_deleteData) {}

  int position(const std::string& joint) const {
    return model->jnt_qposadr[mj_name2id(model.get(), mjOBJ_JOINT, joint.c_str())];
  }
  int dof(const std::string& joint) const {
    return model->jnt_dofadr[mj_name2id(model.get(), mjOBJ_JOINT, joint.c_str())];
  }

 private:
  static mjModel* load(const std::string& file) {
    std::array<char, 1000> error{};
    mjModel* loaded = mj_loadXML(file.c_str(), nullptr, error.data(), int{error.size()});
    if (loaded == nullptr) throw std::runtime_error(file + ": " + error.data());
    return loaded;
  }
};

}  // namespace two_legs

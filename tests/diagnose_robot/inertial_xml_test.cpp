// Masses and inertias that were found go into the corrected model whatever geoms weigh.
#include "apps/diagnose/robot/inertial_xml.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "apps/diagnose/robot/augmented_xml.hpp"
#include "tests/diagnose_robot/small_robots.hpp"

using namespace diagnose_robot;
using robot_test::ScratchFolder;

namespace {

// The small arm with links whose masses follow from their shapes; two bodies have no name.
const std::string geoms = R"(<mujoco><compiler inertiafromgeom="true" angle="radian"/><worldbody>
<body><geom type="box" size="0.1 0.1 0.1" mass="3"/>
<body pos="0 0 0.1"><joint name="upper" axis="0 1 0"/><geom type="capsule" fromto="0 0 0 0 0 -0.25" size="0.03"/>
<body name="lower_link" pos="0 0 -0.25"><joint name="lower" axis="0 1 0"/>
<geom type="capsule" fromto="0 0 0 0.05 0 -0.25" size="0.02"/><site name="lower_end" pos="0 0 -0.25"/></body>
</body></body></worldbody></mujoco>)";

}  // namespace

TEST_CASE("a payload that was found is in the corrected model of links that are weighed by their shapes") {
  const ScratchFolder folder;
  robot_test::write_files(folder, robot_test::small_arm(), 2, 1);
  robot_test::write_text(folder.file("robot.xml"), geoms);
  const Robot robot = robot_test::load(folder);
  RobotPhysics physics(2);
  physics[1][Property::payload] = 0.4;
  physics[0][Property::link_mass] = 0.5;
  const ModelPointer wanted = model_with_bodies(robot, physics);
  const AugmentedModel augmented = augmented_model(robot, physics, 0.001, folder.path());
  std::string complaint;
  const ModelPointer loaded = compile_model(augmented.xml, {}, false, complaint);
  REQUIRE(loaded);
  REQUIRE(loaded->nbody == wanted->nbody);
  for (int body = 1; body < wanted->nbody; ++body) {
    CHECK(loaded->body_mass[body] == doctest::Approx(wanted->body_mass[body]).epsilon(1e-6));
    for (int i = 0; i < 3; ++i) {
      CHECK(loaded->body_inertia[3 * body + i] == doctest::Approx(wanted->body_inertia[3 * body + i]).epsilon(1e-6));
      CHECK(std::abs(loaded->body_ipos[3 * body + i] - wanted->body_ipos[3 * body + i]) < 1e-7);
    }
  }
}

TEST_CASE("an inertia that stands in the text is replaced, and other elements stay") {
  const ScratchFolder folder;
  robot_test::write_files(folder, robot_test::small_arm(), 2, 1);
  const Robot robot = robot_test::load(folder);
  const std::string text =
      "<worldbody><body name=\"a\">\n<inertial mass=\"9\"/><site/></body><body/><bodyless/></worldbody>";
  const std::string with = with_inertials(text, robot.model.model.get());
  CHECK(with.find("mass=\"9\"") == std::string::npos);
  CHECK(with.find("/><site/></body><body><inertial pos=\"0 0 -0.125\"") != std::string::npos);
  CHECK(with.find("</body><bodyless/></worldbody>") != std::string::npos);
}

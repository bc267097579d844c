// Joints that were read can be checked, and are written as they were.
#include "examples/sigmaban/robot/walk/joints_file.hpp"
#include "tests/fuzz/accepted.hpp"
#include "tests/fuzz/feeds.hpp"
#include "tests/fuzz/memory_file.hpp"

void fuzz::joints(Input input) {
  const MemoryFile file(std::as_bytes(input));
  accepted<example::UsageError>([&] {
    const auto joints = sigmaban::read_joints(file.path());
    const std::string text = sigmaban::joints_to_json(joints);
    const MemoryFile again(std::as_bytes(std::span(text)));
    require(sigmaban::joints_to_json(sigmaban::read_joints(again.path())) == text, "joints that are written as others");
    accepted<::dynamixel::BusError>([&] { ::dynamixel::check_joints(joints.joints, joints.joints.size()); });
  });
}

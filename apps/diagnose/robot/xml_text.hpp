// Elements of an XML text, taken out or looked up without a tree; enough for model files.
#pragma once

#include <string>
#include <vector>

namespace diagnose_robot {

bool is_urdf(const std::string& text);

/// The text without all elements of these names, with what is in them.
std::string without_elements(const std::string& text, const std::vector<std::string>& names);

/// Without assets of meshes, and geoms that use them.
std::string without_meshes(const std::string& text);

/// The text with settings of MuJoCo's compiler that make every inertia possible, however small; of MJCF and URDF.
std::string with_possible_inertias(const std::string& text);

/// Without free joints and those named, and without what may refer to them.
std::string without_joints(const std::string& text, const std::vector<std::string>& names);

/// The value of `class` in the element of the joint, empty if it has none.
std::string class_of_joint(const std::string& text, const std::string& joint);

/// An attribute of the opening tag, empty if it is not there.
std::string attribute(const std::string& tag, const std::string& name);

}  // namespace diagnose_robot

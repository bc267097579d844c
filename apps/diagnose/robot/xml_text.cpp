#include "xml_text.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <functional>

namespace diagnose_robot {
namespace {

bool is_name_end(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '/' || c == '>'; }

// Where a comment that begins at `at` ends, or `at`.
std::size_t after_comment(const std::string& text, std::size_t at) {
  if (text.compare(at, 4, "<!--") != 0) return at;
  const std::size_t end = text.find("-->", at);
  return end == std::string::npos ? text.size() : end + 3;
}

// Calls found(begin of tag, end of tag) for each opening tag of the name, until it returns false.
void for_each_tag(const std::string& text, const std::string& name,
                  const std::function<bool(std::size_t, std::size_t)>& found) {
  for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at)) {
    const std::size_t skipped = after_comment(text, at);
    if (skipped != at) {
      at = skipped;
      continue;
    }
    const std::size_t end = text.find('>', at);
    if (end == std::string::npos) return;
    const std::size_t after = at + 1 + name.size();
    if (text.compare(at + 1, name.size(), name) == 0 && after < text.size() && is_name_end(text[after]) &&
        !found(at, end + 1)) {
      return;
    }
    at = end + 1;
  }
}

// The end of the element whose opening tag is [begin, end).
std::size_t end_of_element(const std::string& text, const std::string& name, std::size_t end) {
  if (text[end - 2] == '/') return end;
  const std::string closing = "</" + name;
  const std::size_t close = text.find(closing, end);
  if (close == std::string::npos) return end;
  const std::size_t bracket = text.find('>', close);
  return bracket == std::string::npos ? text.size() : bracket + 1;
}

std::string without(const std::string& text, const std::string& name,
                    const std::function<bool(const std::string&)>& unwanted) {
  std::string result;
  std::size_t kept = 0;
  for_each_tag(text, name, [&](std::size_t begin, std::size_t end) {
    if (begin < kept || !unwanted(text.substr(begin, end - begin))) return true;
    result.append(text, kept, begin - kept);
    kept = end_of_element(text, name, end);
    return true;
  });
  return result.append(text, kept, std::string::npos);
}

}  // namespace

bool is_urdf(const std::string& text) {
  bool found = false;
  for_each_tag(text, "robot", [&](std::size_t, std::size_t) {
    found = true;
    return false;
  });
  return found;
}

std::string without_elements(const std::string& text, const std::vector<std::string>& names) {
  std::string result = text;
  for (const std::string& name : names) {
    result = without(result, name, [](const std::string&) { return true; });
  }
  return result;
}

std::string without_meshes(const std::string& text) {
  const auto uses_mesh = [](const std::string& tag) {
    return !attribute(tag, "mesh").empty() || attribute(tag, "type") == "mesh";
  };
  const std::string no_assets =
      without(text, "mesh", [](const std::string& tag) { return !attribute(tag, "file").empty(); });
  return without_elements(without(no_assets, "geom", uses_mesh), {"visual", "collision"});
}

std::string with_possible_inertias(const std::string& text) {
  const bool urdf = is_urdf(text);
  const std::string settings = R"(<compiler balanceinertia="true" boundmass="1e-6" boundinertia="1e-9"/>)";
  std::string result = text;
  for_each_tag(text, urdf ? "robot" : "mujoco", [&](std::size_t, std::size_t end) {
    if (text[end - 2] != '/') result.insert(end, urdf ? "<mujoco>" + settings + "</mujoco>" : settings);
    return false;
  });
  return result;
}

std::string without_joints(const std::string& text, const std::vector<std::string>& names) {
  const auto unwanted = [&](const std::string& tag) {
    const std::string name = attribute(tag, "name");
    return attribute(tag, "type") == "free" ||
           (!name.empty() && std::find(names.begin(), names.end(), name) != names.end());
  };
  return without(without_elements(text, {"freejoint", "equality", "tendon", "contact", "keyframe"}), "joint", unwanted);
}

std::string attribute(const std::string& tag, const std::string& name) {
  for (std::size_t at = tag.find(name); at != std::string::npos; at = tag.find(name, at + 1)) {
    if (at == 0 || std::isspace(static_cast<unsigned char>(tag[at - 1])) == 0) continue;
    std::size_t quote = at + name.size();
    while (quote < tag.size() && (std::isspace(static_cast<unsigned char>(tag[quote])) != 0 || tag[quote] == '='))
      ++quote;
    if (quote >= tag.size() || (tag[quote] != '"' && tag[quote] != '\'')) continue;
    const std::size_t end = tag.find(tag[quote], quote + 1);
    if (end != std::string::npos) return tag.substr(quote + 1, end - quote - 1);
  }
  return "";
}

std::string class_of_joint(const std::string& text, const std::string& joint) {
  std::string result;
  for (const char* name : {"joint", "hinge"}) {
    for_each_tag(text, name, [&](std::size_t begin, std::size_t end) {
      const std::string tag = text.substr(begin, end - begin);
      if (attribute(tag, "name") == joint) result = attribute(tag, "class");
      return result.empty();
    });
  }
  return result;
}

}  // namespace diagnose_robot

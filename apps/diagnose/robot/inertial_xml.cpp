#include "inertial_xml.hpp"

#include <array>
#include <cstdio>

namespace diagnose_robot {
namespace {

std::string numbers(const mjtNum* values, int count) {
  std::string result;
  for (int i = 0; i < count; ++i) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), i == 0 ? "%.9g" : " %.9g", values[i]);
    result += text.data();
  }
  return result;
}

std::string inertial(const mjModel* m, int body) {
  return "<inertial pos=\"" + numbers(m->body_ipos + 3 * body, 3) + "\" quat=\"" +
         numbers(m->body_iquat + 4 * body, 4) + "\" mass=\"" + numbers(m->body_mass + body, 1) + "\" diaginertia=\"" +
         numbers(m->body_inertia + 3 * body, 3) + "\"/>";
}

// Without an attribute that would undo what is written.
std::string without_attribute(std::string xml, const std::string& name) {
  const std::size_t at = xml.find(" " + name + "=\"");
  if (at == std::string::npos) return xml;
  const std::size_t end = xml.find('"', xml.find('"', at) + 1);
  return xml.erase(at, end + 1 - at);
}

}  // namespace

std::string with_inertials(const std::string& xml, const mjModel* m) {
  std::string result;
  std::size_t done = 0;
  int body = 0;  // the world
  for (std::size_t at = xml.find("<body"); at != std::string::npos && body + 1 < m->nbody; at = xml.find("<body", at)) {
    const std::size_t end = xml.find('>', at);
    if (end == std::string::npos) break;
    const char next = xml[at + 5];
    at = end + 1;
    if (next != ' ' && next != '>' && next != '/') continue;
    ++body;
    if (!(m->body_mass[body] > 0)) continue;
    const bool empty = xml[end - 1] == '/';
    result += xml.substr(done, (empty ? end - 1 : end) - done) + ">" + inertial(m, body) + (empty ? "</body>" : "");
    done = at;
    const std::size_t child = xml.find_first_not_of(" \n\r\t", at);
    if (!empty && child != std::string::npos && xml.compare(child, 9, "<inertial") == 0)
      done = xml.find('>', child) + 1;
  }
  result += xml.substr(done);
  for (const char* name : {"inertiafromgeom", "settotalmass"}) result = without_attribute(std::move(result), name);
  return result;
}

}  // namespace diagnose_robot

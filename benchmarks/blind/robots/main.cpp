// concealed_robots: robots in MuJoCo with physics that their models leave out, for surefoot-diagnose; the truth apart.
// Nothing here comes from the library.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>

#include "robot_case.hpp"

namespace {

constexpr const char* usage =
    "usage: concealed_robots OUT CASES SEED [FAMILY [FAULTS [RECORDINGS SECONDS RATE]]]\n"
    "writes OUT/cases/case_0001/{robot.xml,robot.toml,rec_1.csv,...} and OUT/truth/case_0001.json\n"
    "FAULTS: hidden in each; without it none in a fifth, in others one to three, or swapped columns\n"
    "FAMILY: arm2 to arm7, or legs3, legs6, ... legs24; without it arm2, arm6, arm7 and legs12 take turns\n"
    "RECORDINGS SECONDS RATE: of each robot, their length and rows per second; without them 3 of 6 s at 200 Hz\n";

void write(const std::filesystem::path& file, const std::string& text) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4 || argc == 7 || argc == 8 || argc > 9) {
    std::fputs(usage, stderr);
    return 2;
  }
  try {
    const std::filesystem::path out = argv[1];
    int recordings = 3;
    blind_robots::RecordingLength length;
    if (argc == 9) {
      recordings = std::stoi(argv[6]);
      length = {std::stod(argv[7]), 1 / std::stod(argv[8])};
    }
    const std::vector<std::string> families =
        argc > 4 ? std::vector<std::string>{argv[4]} : std::vector<std::string>{"arm2", "arm6", "arm7", "legs12"};
    for (unsigned long i = 1; i <= std::stoul(argv[2]); ++i) {
      plants::Random random(1000003 * std::stoull(argv[3]) + i);
      const std::string family = families[i % families.size()];
      std::optional<int> faults;
      if (random.chance(0.2)) faults = 0;
      if (argc > 5) faults = std::stoi(argv[5]);
      const auto robot = blind_robots::draw_robot(random, family, faults);
      char name[20];
      std::snprintf(name, sizeof name, "case_%04lu", i);
      const auto folder = out / "cases" / name;
      write(folder / "robot.xml", blind_robots::robot_xml(robot, false));
      write(folder / "robot.toml", blind_robots::robot_setup(robot));
      for (int r = 1; r <= recordings; ++r)
        write(folder / ("rec_" + std::to_string(r) + ".csv"), blind_robots::record(robot, random, length));
      const nlohmann::ordered_json truth{
          {"family", family}, {"drive", robot.torque_driven ? "torque" : "position"}, {"hidden", robot.truth}};
      write(out / "truth" / (std::string(name) + ".json"), truth.dump(1) + "\n");
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "concealed_robots: %s\n", error.what());
    return 1;
  }
}

// spoilt_logs: puts one fault into every other log of a folder of cases and leaves the others as they are; and scores
// which of them a diagnosis names. Nothing here comes from the library.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "faults.hpp"

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* usage =
    "usage: spoilt_logs --draw PLANTS OUT SEED    PLANTS: a folder that concealed_plants wrote\n"
    "       spoilt_logs --score OUT RESULTS       RESULTS: OUT's cases, diagnosed: RESULTS/case_0001/diagnosis.json\n";

Json read_json(const fs::path& file) {
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error("cannot read " + file.string());
  return Json::parse(stream);
}

std::vector<fs::path> sorted(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

spoilt::Log read_log(const fs::path& folder, const std::string& family) {
  static const std::map<std::string, std::size_t> inputs{
      {"servo", 1}, {"carriage", 1}, {"tanks", 1}, {"walk", 3}, {"walk_final", 3}};
  spoilt::Log log;
  log.family = family;
  for (const fs::path& file : sorted(folder)) {
    if (file.extension() != ".csv") continue;
    log.files.push_back(file.filename().string());
    log.recordings.push_back(spoilt::read_table(file));
  }
  const std::vector<std::string>& names = log.recordings.at(0).names;
  for (std::size_t c = 1; c < names.size(); ++c) (c <= inputs.at(family) ? log.inputs : log.outputs).push_back(c);
  log.timed = names[0] == "t_s";
  return log;
}

Json draw_one(plants::Random& random, const std::vector<fs::path>& cases, const fs::path& plants, std::size_t i,
              const std::string& kind, const fs::path& out) {
  const auto family_of = [&](std::size_t c) {
    return read_json(plants / "truth" / (cases[c].filename().string() + ".json")).at("family").get<std::string>();
  };
  spoilt::Log log = read_log(cases[i], family_of(i));
  Json truth{{"case", cases[i].filename().string()}, {"family", log.family}, {"kind", "clean"}};
  if (!kind.empty() && possible(log, kind)) {
    std::vector<std::size_t> donors;  // other machines with the same columns
    for (std::size_t c = 0; c < cases.size(); ++c) {
      if (c == i || family_of(c) != log.family) continue;
      if (read_log(cases[c], log.family).recordings[0].names == log.recordings[0].names) donors.push_back(c);
    }
    if (kind == "odd_recording" && donors.empty()) return nullptr;
    const spoilt::Log donor = donors.empty() ? log : read_log(cases[random.choice(donors)], log.family);
    const spoilt::Spoilt spoilt = spoil(random, log, kind, donor);
    truth.update({{"kind", spoilt.kind}, {"recording", spoilt.recording}, {"channel", spoilt.channel},
                  {"also", spoilt.also}, {"size", spoilt.size}});
  } else if (!kind.empty()) {
    return nullptr;
  }
  const fs::path folder = out / "cases" / cases[i].filename();
  fs::create_directories(folder);
  fs::copy_file(cases[i] / "model.toml", folder / "model.toml", fs::copy_options::overwrite_existing);
  for (std::size_t r = 0; r < log.recordings.size(); ++r) write_table(log.recordings[r], folder / log.files[r]);
  return truth;
}

void draw(const fs::path& plants, const fs::path& out, std::uint64_t seed) {
  plants::Random random(seed);
  const std::vector<fs::path> cases = sorted(plants / "cases");
  Json truths = Json::array();
  std::map<std::string, int> drawn;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (i % 2 == 1) {
      truths.push_back(draw_one(random, cases, plants, i, "", out));
      continue;
    }
    std::vector<std::string> kinds = spoilt::kinds();  // the rarest so far that this log can have
    std::shuffle(kinds.begin(), kinds.end(), random.engine);
    std::ranges::stable_sort(kinds, {}, [&](const std::string& kind) { return drawn[kind]; });
    for (const std::string& kind : kinds) {
      const Json truth = draw_one(random, cases, plants, i, kind, out);
      if (truth.is_null()) continue;
      truths.push_back(truth);
      ++drawn[kind];
      break;
    }
  }
  std::ofstream(out / "truth.json") << truths.dump(1) << '\n';
}

// Whether a fault that was named is the one that was put in.
bool is_right(const Json& fault, const Json& truth) {
  const std::string kind = truth.at("kind"), recording = truth.at("recording");
  if (fault.at("kind") != kind) return false;
  return fault.at("recording") == recording || (kind == "clock_offset" && recording.empty());
}

void score(const fs::path& out, const fs::path& results) {
  struct Count {
    int logs = 0, right = 0, first = 0, others = 0;
  };
  std::map<std::string, Count> counts;
  for (const Json& truth : read_json(out / "truth.json")) {
    const std::string name = truth.at("case"), kind = truth.at("kind");
    Count& count = counts[kind];
    ++count.logs;
    const fs::path file = results / name / "diagnosis.json";
    const Json faults = fs::exists(file) ? read_json(file).at("log_faults") : Json::array();
    bool right = false;
    int others = 0;
    std::string named;
    for (const Json& fault : faults) {
      const bool this_one = kind != "clean" && is_right(fault, truth);
      right = right || this_one;
      others += this_one ? 0 : 1;
      named += "\n      " + fault.at("sentence").get<std::string>().substr(0, 150);
    }
    count.right += right ? 1 : 0;
    count.others += others > 0 ? 1 : 0;
    if (!fs::exists(file)) named = " no diagnosis";
    if ((kind == "clean" && others > 0) || (kind != "clean" && (!right || others > 0)) || !fs::exists(file)) {
      const std::string what = kind == "clean" ? "" : " of " + truth.at("recording").get<std::string>() + " " +
                               truth.at("channel").get<std::string>() + " " + truth.at("size").dump();
      std::printf("%s %s: %s%s%s; named:%s\n", name.c_str(), truth.at("family").get<std::string>().c_str(),
                  kind.c_str(), what.c_str(), right ? " (found)" : "", named.empty() ? " nothing" : named.c_str());
    }
  }
  std::printf("\n%-18s %5s %6s %s\n", "kind", "logs", "named", "with others named too (of clean logs: false alarms)");
  Count all;
  for (const auto& [kind, count] : counts) {
    std::printf("%-18s %5d %6d %d\n", kind.c_str(), count.logs, count.right, count.others);
    if (kind == "clean") continue;
    all.logs += count.logs, all.right += count.right, all.others += count.others;
  }
  std::printf("%-18s %5d %6d %d\n", "all spoilt", all.logs, all.right, all.others);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const std::vector<std::string> words(argv + 1, argv + argc);
    if (words.size() == 4 && words[0] == "--draw") {
      draw(words[1], words[2], std::stoull(words[3]));
    } else if (words.size() == 3 && words[0] == "--score") {
      score(words[1], words[2]);
    } else {
      std::fputs(usage, stderr);
      return 2;
    }
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "spoilt_logs: %s\n", error.what());
    return 1;
  }
}

// concealed_invariance: how often diagnoses of the same machine agree, whatever the seed, the starting values and the
// order of the recordings.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr const char* usage =
    "usage: concealed_invariance RESULTS    RESULTS/VARIANT/case_0001/diagnosis.json; seed_1 is what others have to "
    "be\n";
constexpr const char* reference = "seed_1";

/// Effects with their places, as text; none: nothing is named.
using Structure = std::set<std::string>;

struct Answer {
  Structure first;
  std::set<Structure> stated;  // the first one, and those that the recordings cannot tell from it
  bool complete = true;
};

Structure structure_of(const Json& effects) {
  Structure structure;
  for (const Json& one : effects) {
    structure.insert(one.at("name").get<std::string>() + " at " + one.at("attached_to").get<std::string>());
  }
  return structure;
}

Answer read_answer(const fs::path& file) {
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error("cannot read " + file.string());
  const Json json = Json::parse(stream);
  Answer answer{structure_of(json.at("effects")), {}, json.at("complete").get<bool>()};
  answer.stated.insert(answer.first);
  for (const Json& one : json.at("alternatives")) {
    if (one.at("indistinguishable").get<bool>()) answer.stated.insert(structure_of(one.at("effects")));
  }
  return answer;
}

std::string text_of(const Structure& structure) {
  std::string text;
  for (const std::string& effect : structure) text += (text.empty() ? "" : " and ") + effect;
  return text.empty() ? "nothing" : text;
}

std::vector<fs::path> sorted(const fs::path& folder) {
  std::vector<fs::path> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename());
  std::ranges::sort(names);
  return names;
}

struct Count {
  std::size_t all = 0, same = 0, in_class = 0;
};

Count compare(const fs::path& results, const fs::path& variant) {
  Count count;
  for (const fs::path& name : sorted(results / variant)) {
    const fs::path expected = results / reference / name / "diagnosis.json",
                   file = results / variant / name / "diagnosis.json";
    if (!fs::exists(expected) || !fs::exists(file)) continue;
    const Answer one = read_answer(expected), other = read_answer(file);
    const bool same = one.first == other.first;
    const bool in_class = same || (one.stated.contains(other.first) && other.stated.contains(one.first));
    ++count.all;
    count.same += same ? 1 : 0;
    count.in_class += in_class ? 1 : 0;
    if (same) continue;
    std::printf("%s %s: %s; with %s: %s%s%s\n", name.c_str(), reference, text_of(one.first).c_str(), variant.c_str(),
                text_of(other.first).c_str(), in_class ? " (of the same class)" : "",
                one.complete && other.complete ? "" : " (not finished)");
  }
  return count;
}

void score(const fs::path& results) {
  Count all;
  std::vector<std::pair<std::string, Count>> counts;
  for (const fs::path& variant : sorted(results)) {
    if (variant == reference) continue;
    counts.emplace_back(variant.string(), compare(results, variant));
  }
  std::printf("\n%-12s %6s %6s %s\n", "variant", "cases", "same", "same or of a class that both state");
  for (const auto& [variant, count] : counts) {
    std::printf("%-12s %6zu %6zu %6zu\n", variant.c_str(), count.all, count.same, count.in_class);
    all.all += count.all, all.same += count.same, all.in_class += count.in_class;
  }
  std::printf("%-12s %6zu %6zu %6zu\n", "all", all.all, all.same, all.in_class);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc != 2) {
      std::fputs(usage, stderr);
      return 2;
    }
    score(argv[1]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "concealed_invariance: %s\n", error.what());
    return 1;
  }
}

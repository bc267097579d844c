// concealed_machines: writes cases for the blind benchmark whose machines are drawn from a grammar and, apart from
// them, the truth. Nothing here comes from the library.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <fstream>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>

#include "equivalents.hpp"

namespace {

constexpr const char* usage =
    "usage: concealed_machines --out DIR --cases N --seed S [--machines development|examination]\n"
    "                          [--inputs held|linear|before]   between rows, which model files do not say\n"
    "                          [--hidden nothing|one|two|outside]   effects in every case; by default all of these\n"
    "writes DIR/cases/case_0001/{model.toml,rec_01.csv,...} and DIR/truth/case_0001.json\n";

struct Options {
  std::filesystem::path out;
  std::size_t cases = 0;
  std::uint64_t seed = 1;
  machines::Grammar grammar;
  bool logged_late = false;            // each row holds the inputs that acted before it
  std::optional<plants::Kind> hidden;  // in every case; else as kinds() says
};

std::uint64_t whole_number(const std::string& option, const std::string& given) {
  const bool digits = !given.empty() && given.size() < 19 && given.find_first_not_of("0123456789") == std::string::npos;
  if (!digits) throw std::invalid_argument(option + " needs a whole number, not '" + given + "'");
  return std::stoull(given);
}

const std::map<std::string, plants::Kind>& kind_names() {
  using plants::Kind;
  static const std::map<std::string, Kind> names{
      {"nothing", Kind::nothing}, {"one", Kind::one}, {"two", Kind::two}, {"outside", Kind::outside}};
  return names;
}

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; i += 2) {
    const std::string option = argv[i];
    if (i + 1 >= argc) throw std::invalid_argument(option + " needs a value");
    const std::string given = argv[i + 1];
    if (option == "--out") {
      options.out = given;
    } else if (option == "--cases") {
      options.cases = whole_number(option, given);
    } else if (option == "--seed") {
      options.seed = whole_number(option, given);
    } else if (option == "--machines") {
      if (given != "development" && given != "examination")
        throw std::invalid_argument("--machines is development or examination, not '" + given + "'");
      options.grammar.examination = given == "examination";
    } else if (option == "--inputs") {
      if (given != "held" && given != "linear" && given != "before")
        throw std::invalid_argument("--inputs is held, linear or before, not '" + given + "'");
      options.grammar.linear_inputs = given == "linear";
      options.logged_late = given == "before";
    } else if (option == "--hidden") {
      const auto at = kind_names().find(given);
      if (at == kind_names().end())
        throw std::invalid_argument("--hidden is nothing, one, two or outside, not '" + given + "'");
      options.hidden = at->second;
    } else {
      throw std::invalid_argument("unknown option " + option);
    }
  }
  if (options.out.empty() || options.cases == 0) throw std::invalid_argument("--out and --cases are needed");
  return options;
}

// 25 % nothing, 45 % one effect, 15 % two, 15 % outside, in shuffled order.
std::vector<plants::Kind> kinds(std::size_t count, plants::Random& random) {
  using plants::Kind;
  std::vector<Kind> list;
  for (std::size_t i = 0; i < count; ++i) {
    const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    list.push_back(share < 0.25 ? Kind::nothing : share < 0.70 ? Kind::one : share < 0.85 ? Kind::two : Kind::outside);
  }
  std::shuffle(list.begin(), list.end(), random.engine);
  return list;
}

// Every row gets the inputs of the row before it.
void log_late(std::vector<plants::Recording>& recordings) {
  for (plants::Recording& recording : recordings)
    for (plants::Column& column : recording.inputs) std::shift_right(column.begin(), column.end(), 1);
}

void generate(const Options& options) {
  plants::Random plan(options.seed);
  std::vector<plants::Kind> planned = kinds(options.cases, plan);
  if (options.hidden) std::ranges::fill(planned, *options.hidden);
  std::filesystem::create_directories(options.out / "truth");
  for (std::size_t i = 0; i < options.cases; ++i) {
    plants::Random random(options.seed * 1000003 + i);
    machines::Drawn drawn =
        machines::draw_case(random, options.grammar, random.choice(machines::families()), planned[i]);
    for (std::size_t k = 0; k < drawn.hidden.size() && drawn.one.kind != plants::Kind::outside; ++k)
      for (auto& other : machines::equivalents(drawn, k)) drawn.one.faults[k].equivalents.push_back(std::move(other));
    char name[32];
    std::snprintf(name, sizeof name, "case_%04zu", i + 1);
    drawn.one.name = name;
    if (options.logged_late) log_late(drawn.one.system.recordings);
    plants::write_case(drawn.one, options.out / "cases");
    plants::write_truth(drawn.one, options.out / "truth" / (drawn.one.name + ".json"));
    if ((i + 1) % 20 == 0) std::printf("machines: %zu of %zu cases\n", i + 1, options.cases);
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    generate(parse(argc, argv));
    return 0;
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "concealed_machines: %s\n%s", error.what(), usage);
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "concealed_machines: %s\n", error.what());
    return 1;
  }
}

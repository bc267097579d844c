// concealed_plants: writes cases for the blind benchmark, machines with physics that their model files leave out, and,
// apart from them, the truth. Nothing here comes from the library.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <exception>
#include <sstream>
#include <stdexcept>

#include "case.hpp"

namespace {

constexpr const char* usage =
    "usage: concealed_plants --out DIR --cases N --seed S [--families servo,carriage,tanks,walk,walk_final]\n"
    "writes DIR/cases/case_0001/{model.toml,rec_01.csv,...} and DIR/truth/case_0001.json\n";

struct Options {
  std::filesystem::path out;
  std::size_t cases = 0;
  std::uint64_t seed = 1;
  std::vector<std::string> families{"servo", "carriage", "tanks", "walk", "walk_final"};
};

std::uint64_t whole_number(const std::string& option, const std::string& given) {
  const bool digits = !given.empty() && given.size() < 19 && given.find_first_not_of("0123456789") == std::string::npos;
  if (!digits) throw std::invalid_argument(option + " needs a whole number, not '" + given + "'");
  return std::stoull(given);
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
    } else if (option == "--families") {
      options.families.clear();
      std::stringstream list(given);
      for (std::string family; std::getline(list, family, ',');) options.families.push_back(family);
    } else {
      throw std::invalid_argument("unknown option " + option);
    }
  }
  if (options.out.empty() || options.cases == 0) throw std::invalid_argument("--out and --cases are needed");
  return options;
}

// Kinds in their shares (25 % nothing, 45 % one, 15 % two, 15 % outside) for each family, then shuffled.
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

void generate(const Options& options) {
  const std::size_t families = options.families.size();
  std::vector<std::vector<plants::Kind>> planned;
  plants::Random plan(options.seed);
  for (std::size_t f = 0; f < families; ++f)
    planned.push_back(kinds((options.cases + families - 1 - f) / families, plan));
  std::filesystem::create_directories(options.out / "truth");
  for (std::size_t i = 0; i < options.cases; ++i) {
    char name[32];
    std::snprintf(name, sizeof name, "case_%04zu", i + 1);
    plants::Random random(options.seed * 1000003 + i);
    plants::Case one = plants::draw_case(random, options.families[i % families], planned[i % families][i / families]);
    one.name = name;
    plants::write_case(one, options.out / "cases");
    plants::write_truth(one, options.out / "truth" / (one.name + ".json"));
    if ((i + 1) % 20 == 0) std::printf("plants: %zu of %zu cases\n", i + 1, options.cases);
    std::fflush(stdout);
  }
  std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) {
  try {
    generate(parse(argc, argv));
    return 0;
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "concealed_plants: %s\n%s", error.what(), usage);
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "concealed_plants: %s\n", error.what());
    return 1;
  }
}

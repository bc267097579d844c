// Writes the effect catalogue of the documentation from the library as compiled: effects.md and one picture per effect.
//   effect_catalogue DOCS            writes DOCS/effects.md and DOCS/pictures/effects/*.png (needs gnuplot)
//   effect_catalogue --check DOCS    exits with 1 unless DOCS/effects.md is what it would write, with all its pictures
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "../../apps/common/files.hpp"
#include "../../apps/common/gnuplot.hpp"
#include "catalogue_entries.hpp"
#include "catalogue_machines.hpp"
#include "surefoot/diagnose/simulate_augmented.hpp"
#include "surefoot/diagnose/text.hpp"

namespace catalogue {
namespace {

using surefoot::Effect;
using surefoot::Place;

struct Section {
  Place place;
  std::string title, where;
};

std::vector<Section> sections() {
  return {{Place::velocity, "Forces on a speed", "a state that is the speed of another, or has an `effort`"},
          {Place::state, "Changes of a state",
           "a state that is neither a speed, nor what a speed belongs to, nor part of a pose"},
          {Place::input, "On the way of an input", "an input, or a signal inside the equations that inputs drive"},
          {Place::output, "In a sensor", "an output"},
          {Place::planar, "Walking in the plane", "the displacement of a step (maps with a pose)"},
          {Place::parameter, "In a parameter", "a parameter that is not fixed"}};
}

struct Shown {
  surefoot::SimulatedRun without, with;
  Eigen::VectorXd time;
  std::string place, time_unit = {}, reading = {};
  std::map<std::string, std::string> units = {};  // of the parameters
};

template <class Machine>
Shown simulate(const Effect& effect, const Form& form, const std::string& place) {
  const Machine machine;
  const surefoot::Recording commands = Machine::commands();
  const surefoot::Integration fine{.step = 0.0025};
  surefoot::Augmented changed{.integration = fine};
  changed.effects = {{.name = effect.name, .attached_to = place, .form = effect.form, .values = form.values}};
  Shown shown{.without = simulate_augmented(machine, {.integration = fine}, commands),
              .with = simulate_augmented(machine, changed, commands),
              .time = commands.time,
              .place = place};
  const surefoot::SimulatorInfo info = machine.info();
  shown.time_unit = info.kind == surefoot::SimulatorKind::map ? "step" : "time [s]";
  shown.reading = info.outputs[0].name + " [" + info.outputs[0].unit + "]";
  const std::vector<std::string> units = units_of(machine, changed.effects[0], commands);
  for (std::size_t i = 0; i < units.size(); ++i) shown.units[effect.parameters[i].name] = units[i];
  return shown;
}

Shown show(const Effect& effect, const Form& form) {
  switch (effect.place) {
    case Place::velocity:
      return simulate<Arm>(effect, form, "speed");
    case Place::state:
      return simulate<Tanks>(effect, form, "upper");
    case Place::input:
      return simulate<Arm>(effect, form, "torque");
    case Place::output:
      return simulate<Arm>(effect, form, "angle");
    case Place::parameter:
      return simulate<Arm>(effect, form, "weight");
    case Place::planar:
      break;
  }
  return simulate<Walker>(effect, form, "planar");
}

/// Left: readings without and with the effect (walks: the path). Right: the residual, with minus without.
void draw(const std::filesystem::path& picture, const Effect& effect, const Shown& shown) {
  std::ostringstream data;
  const auto outputs = shown.with.outputs.rows();
  for (Eigen::Index row = 0; row < shown.time.size(); ++row) {
    data << shown.time[row];
    for (Eigen::Index o = 0; o < outputs; ++o) {
      data << ' ' << shown.without.outputs(o, row) << ' ' << shown.with.outputs(o, row);
    }
    data << '\n';
  }
  const auto line = [](const std::string& columns, const std::string& color, const std::string& title) {
    return "data using " + columns + " with lines lw 1.5 lc rgb '#" + color + "' " +
           (title.empty() ? "notitle" : "title '" + title + "'");
  };
  const std::string grey = "888888", red = "c0392b", blue = "2471a3", green = "229954";
  std::string commands =
      "set multiplot layout 1,2\nset termoption font 'sans,8'\nset tics scale 0.5 nomirror\nset border 3\n"
      "set key top left samplen 1\n";
  if (effect.place == Place::planar) {
    commands +=
        "set size ratio -1\nset xrange [-0.1:1.1]\nset yrange [-0.1:0.8]\nset xtics 0.2\nset ytics 0.2\n"
        "set xlabel 'x [m]'\nset ylabel 'y [m]'\nplot " +
        line("2:4", grey, "without") + ", " + line("3:5", red, "with") +
        "\nset size noratio\nset autoscale\nset xtics auto\nset ytics auto\nset xlabel 'step'\n"
        "set ylabel 'residual'\nplot " +
        line("1:($3-$2)", red, "x [m]") + ", " + line("1:($5-$4)", blue, "y [m]") + ", " +
        line("1:($7-$6)", green, "heading [rad]") + "\n";
  } else {
    commands += "set xlabel '" + shown.time_unit + "'\nset ylabel '" + shown.reading +
                "'\nset offsets 0,0,graph 0.3,0\nplot " + line("1:2", grey, "without") + ", " +
                line("1:3", red, "with") + "\nset ylabel 'residual'\nset offsets 0,0,0,0\nplot " +
                line("1:($3-$2)", red, "") + "\n";
  }
  commands += "unset multiplot\n";
  const auto scratch = std::filesystem::temp_directory_path() / ("surefoot_" + effect.name);
  example::draw(scratch, commands, data.str(), 600, 180);
  std::filesystem::create_directories(picture.parent_path());
  std::filesystem::copy_file(scratch.string() + ".png", picture, std::filesystem::copy_options::overwrite_existing);
  for (const char* ending : {".gp", ".dat", ".svg", ".png"}) std::filesystem::remove(scratch.string() + ending);
}

std::string in_code(const std::string& text) { return "`" + text + "`"; }

/// "{level}" becomes *level*, "{at}" the name of the place.
std::string sentence_of(const Effect& effect, const std::string& place) {
  std::vector<surefoot::FittedValue> none;
  std::string text = effect.sentence;
  for (const auto& parameter : effect.parameters) {
    const std::string mark = "{" + parameter.name + "}";
    for (auto at = text.find(mark); at != std::string::npos; at = text.find(mark)) {
      text.replace(at, mark.size(), "*" + parameter.name + "*");
    }
  }
  return fill_sentence(text, place, none);
}

class Catalogue {
 public:
  explicit Catalogue(bool pictures, std::filesystem::path docs) : pictures_(pictures), docs_(std::move(docs)) {}

  std::string write() {
    std::vector<Effect> all = surefoot::all_effects();
    const auto unsettled = std::erase_if(all, [](const Effect& effect) { return effect.starts_anywhere; });
    std::vector<std::string> names;
    for (const Effect& effect : all) {
      if (std::ranges::find(names, effect.name) == names.end()) names.push_back(effect.name);
      if (find_form(effect) == nullptr) {
        throw surefoot::Error("catalogue_entries.hpp: lacks effect " + effect.name + ", form '" + effect.form + "'");
      }
    }
    for (const Form& form : forms_) {
      if (std::ranges::none_of(all, [&](const Effect& e) { return e.name == form.name && e.form == form.form; })) {
        throw surefoot::Error("catalogue_entries.hpp: the library has no effect " + form.name + ", form '" + form.form +
                              "'");
      }
    }
    text_
        << "# Effect catalogue\n\n"
           "The "
        << names.size() << " pieces of missing physics that `surefoot-diagnose` knows by name, in " << all.size()
        << " forms. Each picture shows a machine without the effect (grey) and with it (red), and beside it the "
           "residual, before any calibration: parameters of a model can take up a part of it, and noise hides what "
           "is small. [How a diagnosis decides](how-it-decides.md) between them is another page; "
           "[one of your own](add-an-effect.md) is twenty lines.\n\n"
           "In formulas q is a position, v its speed, F a force, u an input, y a reading, x a state, d the "
           "displacement of a step. Units are those of the machine of the picture; bounds of the search are "
           "multiples of "
           "the typical size that a parameter of this kind has in the recordings. A typical size is a root mean "
           "square over all recordings, along the calibrated model: of an input, of a state (of a position about its "
           "mean), of a rate, or of the forces on a speed; of a time it is 200 rows. The machines are an arm (torque "
           "in, angle out), "
           "two tanks (inflow in, level of the upper one out), and a robot that walks.\n\n"
           "Some effects are the same exactly on some machines, and a diagnosis then names all of them: one late "
           "input and late sensors of all outputs, in open loop from rest. What parameters of the model can do is not "
           "named at all: a gain of an input that one of them scales. `presliding` dry friction and plain hysteresis "
           "share a formula: with a width up to 0.05 typical sizes of the position it is called friction, beyond "
           "that hysteresis.\n\n"
           "Forms whose hidden states a recording may find at any value are also there as `..., not settled` ("
        << unsettled
        << " more): each recording then tells where it begins.\n\n"
           "This page is written by `examples/guides/effect_catalogue.cpp` from the compiled library.\n";
    for (const Section& section : sections()) {
      text_ << "\n## " << section.title << "\n\nAttaches to " << section.where << ".\n";
      for (const std::string& name : names) {
        const auto first = std::ranges::find(all, name, &Effect::name);
        if (first->place == section.place) entry(all, *first);
      }
    }
    return text_.str();
  }

 private:
  const Form* find_form(const Effect& effect) const {
    for (const Form& form : forms_) {
      if (form.name == effect.name && form.form == effect.form) return &form;
    }
    return nullptr;
  }

  void entry(const std::vector<Effect>& all, const Effect& first) {
    const Form& form = *find_form(first);
    const Shown shown = show(first, form);
    const std::filesystem::path picture = std::filesystem::path("pictures") / "effects" / (first.name + ".png");
    if (pictures_) draw(docs_ / picture, first, shown);
    if (!std::filesystem::exists(docs_ / picture)) {
      throw surefoot::Error((docs_ / picture).string() + ": is missing, run effect_catalogue without --check");
    }
    std::string drawn;
    for (std::size_t i = 0; i < first.parameters.size(); ++i) {
      const std::string& parameter = first.parameters[i].name;
      drawn += (i > 0 ? ", " : "") + parameter + " " + surefoot::with_unit(form.values[i], shown.units.at(parameter));
    }
    text_ << "\n### " << first.name << "\n\nIn a diagnosis: “" << sentence_of(first, shown.place) << "”.\n\n!["
          << first.name << " on the simulated machine: readings, and the residual](" << picture.generic_string()
          << ")\n\n*Drawn with " << drawn << ".*\n\n| form | formula |\n| --- | --- |\n";
    for (const Effect& effect : all) {
      if (effect.name == first.name) {
        text_ << "| " << (effect.form.empty() ? "plain" : in_code(effect.form)) << " | "
              << escaped(find_form(effect)->formula) << " |\n";
      }
    }
    text_ << "\n| parameter | unit | searched in [typical sizes] |\n| --- | --- | --- |\n";
    for (const auto& parameter : first.parameters) {
      text_ << "| " << in_code(parameter.name) << " | " << shown.units.at(parameter.name) << " | "
            << surefoot::in_digits(parameter.low) << " to " << surefoot::in_digits(parameter.high) << " |\n";
    }
    text_ << "\n- **Signature**: " << form.mark << ".\n- **Confusable with**: ";
    for (std::size_t i = 0; i < first.confusable_with.size(); ++i) {
      text_ << (i > 0 ? ", " : "") << "[" << first.confusable_with[i] << "](#" << first.confusable_with[i] << ")";
    }
    text_ << ".\n- **Experiment that shows it by itself**: " << first.experiment
          << ".\n- **Source**: `surefoot/diagnose/effects/" << first.name << ".hpp`, with the literature.\n";
  }

  static std::string escaped(const std::string& formula) {
    std::string text;
    for (const char c : formula) text += c == '|' ? std::string("\\|") : std::string(1, c);
    return "`" + text + "`";
  }

  bool pictures_;
  std::filesystem::path docs_;
  std::vector<Form> forms_ = forms();
  std::ostringstream text_;
};

int run(bool check, const std::filesystem::path& docs) {
  const std::filesystem::path page = docs / "effects.md";
  if (!std::filesystem::is_directory(docs)) throw surefoot::Error(docs.string() + ": is no folder");
  const std::string text = Catalogue(!check, docs).write();
  if (!check) {
    example::write_text(page, text);
    return 0;
  }
  std::ifstream file(page);
  const std::string found{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (found == text) return 0;
  throw surefoot::Error(page.string() + ": is not what the library says; run effect_catalogue " + docs.string());
}

}  // namespace
}  // namespace catalogue

int main(int argc, char** argv) {
  const bool check = argc > 1 && std::strcmp(argv[1], "--check") == 0;
  if (argc != (check ? 3 : 2)) {
    std::fprintf(stderr, "usage: effect_catalogue [--check] FOLDER_OF_THE_DOCS\n");
    return 2;
  }
  try {
    return catalogue::run(check, argv[argc - 1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "effect_catalogue: %s\n", error.what());
    return 1;
  }
}

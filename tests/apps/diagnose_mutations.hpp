// Random damage to model files and recordings: whatever comes, one clear sentence or a sound result.
#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>

#include "apps/diagnose/equations.hpp"
#include "apps/diagnose/load_recording.hpp"
#include "apps/diagnose/write_augmented.hpp"
#include "surefoot/core/rng.hpp"
#include "tests/apps/diagnose_models.hpp"

namespace diagnose_test {

inline std::size_t below(surefoot::Rng& rng, std::size_t count) {
  return static_cast<std::size_t>(rng.uniform() * static_cast<double>(count));
}

/// One to three changes: a character, a stretch removed or repeated, or a piece that is likely to hurt.
inline std::string damaged(std::string text, surefoot::Rng& rng) {
  constexpr std::string_view pieces[] = {"nan", "1e999", "-",   "\"",    "[[",      "]",    "{",    "}", "=",
                                         "\n",  "\r",    ",",   "#",     "0",       "(((",  ")",    "^", "?",
                                         ":",   "theta", "tau", "meta:", "column:", "free", "\xFF", ";"};
  const std::size_t changes = 1 + below(rng, 2) * below(rng, 3);
  for (std::size_t i = 0; i < changes && !text.empty(); ++i) {
    const std::size_t at = below(rng, text.size());
    const std::size_t length = std::min(text.size() - at, 1 + below(rng, 1 + below(rng, 20)));
    switch (below(rng, 9) / 2) {
      case 0:
        text[at] = i == 0 ? text[below(rng, text.size())] : static_cast<char>(below(rng, 256));
        break;
      case 1:
        text.erase(at, length);
        break;
      case 2:
        text.insert(below(rng, text.size()), text.substr(at, length));
        break;
      case 3:
        text.insert(at, pieces[below(rng, std::size(pieces))]);
        break;
      default:
        text.resize(at);
        if (i > 0) break;
        text += pieces[below(rng, std::size(pieces))];
    }
  }
  return text;
}

struct MutationCounts {
  std::size_t read = 0, refused = 0, bad_messages = 0;
  std::string bad_message;  // an example
};

inline void count_message(const std::string& what, MutationCounts& counts) {
  ++counts.refused;
  if (what.size() > 12 && what.size() < 1000 && what.find('\n') == std::string::npos) return;
  ++counts.bad_messages;
  counts.bad_message = what;
}

/// Reads a damaged model file, and if it is still one computes with it and writes it again.
inline void try_model(const std::string& text, MutationCounts& counts) {
  using namespace diagnose_program;
  try {
    const ModelFile model = parse_model_file(text, "model.toml");
    parse_model_file(model_text(model), "written.toml");
    Eigen::VectorXd p(static_cast<Eigen::Index>(model.parameters.size()));
    for (std::size_t i = 0; i < model.parameters.size(); ++i)
      p[static_cast<Eigen::Index>(i)] = model.parameters[i].value;
    const Channels x = Channels::Constant(static_cast<Eigen::Index>(model.states.size()), 0.1);
    const Channels u = Channels::Constant(static_cast<Eigen::Index>(model.inputs.size()), 0.2);
    if (model.kind == surefoot::SimulatorKind::ode) {
      OdeModel simulator(model);
      simulator.prepare(p);
      simulator.derivative(x, u, p);
      simulator.observe(x, u, p);
    } else {
      MapModel simulator(model);
      simulator.prepare(p);
      simulator.next(x, u, p);
    }
    ++counts.read;
  } catch (const surefoot::DiagnoseError& error) {
    count_message(error.what(), counts);
  }
}

inline void try_recording(const std::string& text, const diagnose_program::Layout& layout, MutationCounts& counts) {
  using namespace diagnose_program;
  try {
    for (const auto& recording : recordings_of(parse_csv(text, "rec.csv"), layout).recordings) {
      const bool sound = recording.rows() >= 2 && recording.time.allFinite() && recording.inputs.allFinite() &&
                         recording.initial.allFinite();
      if (!sound) ++counts.bad_messages;
    }
    ++counts.read;
  } catch (const surefoot::DiagnoseError& error) {
    count_message(error.what(), counts);
  }
}

}  // namespace diagnose_test

// A diagnosis from the command line to the files, for any simulator.
#pragma once

#include <functional>

#include "command_line.hpp"
#include "layout.hpp"
#include "model_file.hpp"
#include "surefoot/diagnose/simulator.hpp"
#include "surefoot_apps/diagnose_main.hpp"

namespace diagnose_program {

inline constexpr int exit_done = 0, exit_wrong_input = 2, exit_interrupted = 130;

/// Reads the options, does the work, and turns what is thrown into one sentence and an exit code.
int guarded(int argc, char** argv, bool with_model, const std::function<int(const CommandLine&)>& work);

/// `model` is null for a simulator in C++.
int run(const surefoot::SimulatorInfo& info, const surefoot_apps::DiagnoseFunction& diagnose, const Layout& layout,
        const CommandLine& line, const ModelFile* model);

}  // namespace diagnose_program

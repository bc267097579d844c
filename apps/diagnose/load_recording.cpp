#include "load_recording.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "evaluate_once.hpp"
#include "expression.hpp"
#include "names.hpp"
#include "start_guess.hpp"
#include "units.hpp"

namespace diagnose_program {
namespace {

using surefoot::DiagnoseError;
using surefoot::Recording;

struct Rows {
  std::size_t from, to;
};

[[noreturn]] void fail(const Csv& csv, std::size_t row, const std::string& what) {
  throw DiagnoseError(csv.file + ", line " + std::to_string(csv.lines[row]) + ": " + what);
}

// Stretches of rows in which the column of sequence numbers does not change.
std::vector<Rows> sequences(const Csv& csv, const Layout& layout) {
  if (layout.sequence.empty()) return {{0, csv.rows()}};
  const std::vector<double>& number = numbers(csv, layout.sequence, "which tells sequences apart");
  std::vector<Rows> result;
  for (std::size_t row = 0; row < csv.rows(); ++row) {
    if (std::isnan(number[row]))
      fail(csv, row, "column " + in_quotes(layout.sequence) + " is empty; every row needs it");
    if (row == 0 || number[row] != number[row - 1]) result.push_back({row, row});
    result.back().to = row + 1;
  }
  return result;
}

void read_constants(const Csv& csv, const Layout& layout, Recording& recording) {
  for (const auto& [key, text] : csv.meta) {
    const double value = number_or_nan(text);
    if (std::isfinite(value)) recording.constants[key] = value;
  }
  for (const ModelConstant& constant : layout.constants) {
    if (constant.meta.empty() || recording.constants.contains(constant.meta)) continue;
    const auto text = csv.meta.find(constant.meta);
    std::vector<std::string> keys;
    for (const auto& entry : csv.meta) keys.push_back(entry.first);
    throw DiagnoseError(csv.file + ": the model wants the constant " + in_quotes(constant.meta) +
                        (text == csv.meta.end()
                             ? ", but no first line '# " + printable(constant.meta) + ": number' is there" +
                                   (keys.empty() ? "" : "; the file has " + listed(keys))
                             : ", but its first line says " + in_quotes(text->second) + ", which is no number"));
  }
}

void read_time(const Csv& csv, const Layout& layout, const Rows& rows, Recording& recording) {
  const auto count = static_cast<Eigen::Index>(rows.to - rows.from);
  recording.time = Eigen::VectorXd::LinSpaced(count, 0, static_cast<double>(count - 1));
  if (!layout.ode) return;
  const std::vector<double>& time = numbers(csv, layout.time, "which the model names as its time");
  for (std::size_t row = rows.from; row < rows.to; ++row) {
    if (std::isnan(time[row]))
      fail(csv, row, "column " + in_quotes(layout.time) + " is empty; every row needs its time");
    if (row > rows.from && !(time[row] > time[row - 1])) {
      fail(csv, row,
           "column " + in_quotes(layout.time) + " does not rise, " + number_text(time[row]) + " follows " +
               number_text(time[row - 1]) + "; sort the rows by time and remove repeated ones");
    }
    recording.time[static_cast<Eigen::Index>(row - rows.from)] = time[row];
  }
}

void read_inputs(const Csv& csv, const Layout& layout, const Rows& rows, Recording& recording) {
  recording.inputs.resize(static_cast<Eigen::Index>(layout.inputs.size()), recording.rows());
  for (std::size_t i = 0; i < layout.inputs.size(); ++i) {
    const std::string& name = layout.inputs[i].column;
    const std::vector<double>& column = numbers(csv, name, "which the model reads as an input");
    for (std::size_t row = rows.from; row < rows.to; ++row) {
      double value = column[row];
      const bool unused = row + 1 == rows.to && row > rows.from && !layout.measured_after_step;
      if (std::isnan(value) && unused) value = column[row - 1];
      if (std::isnan(value)) {
        fail(csv, row, "column " + in_quotes(name) + " is empty; an input must be known in every row");
      }
      recording.inputs(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(row - rows.from)) = value;
    }
  }
}

void read_outputs(const Csv& csv, const Layout& layout, const Rows& rows, Recording& recording) {
  recording.outputs.resize(static_cast<Eigen::Index>(layout.outputs.size()), recording.rows());
  for (std::size_t i = 0; i < layout.outputs.size(); ++i) {
    const std::string& name = layout.outputs[i];
    const std::vector<double>& column = numbers(csv, name, "which the model lists in [outputs]");
    const auto begin = column.begin() + static_cast<std::ptrdiff_t>(rows.from);
    const auto end = column.begin() + static_cast<std::ptrdiff_t>(rows.to);
    const auto first = std::find_if(begin, end, [](double value) { return !std::isnan(value); });
    if (first == end) {
      throw DiagnoseError(recording.name + ": column " + in_quotes(name) +
                          " holds no number at all; remove this output from the model or this file from the list");
    }
    std::copy(begin, end, recording.outputs.row(static_cast<Eigen::Index>(i)).begin());
  }
}

// A row for the state before the first step: its outputs were not measured.
void shift_outputs(Recording& recording) {
  const Eigen::Index rows = recording.rows();
  recording.time = Eigen::VectorXd::LinSpaced(rows + 1, 0, static_cast<double>(rows));
  recording.inputs.conservativeResize(Eigen::NoChange, rows + 1);
  recording.inputs.col(rows) = recording.inputs.col(rows - 1);
  Eigen::MatrixXd outputs(recording.outputs.rows(), rows + 1);
  outputs.col(0).setConstant(std::nan(""));
  outputs.rightCols(rows) = recording.outputs;
  recording.outputs = std::move(outputs);
}

// Where a state starts whose first cell is empty and that is read in this row: on the line through the next two
// readings, unless that goes further back than they are apart.
StartGuess extrapolated(const std::vector<double>& column, std::size_t row, const Rows& rows,
                        const Recording& recording) {
  std::size_t next = row + 1;
  while (next < rows.to && std::isnan(column[next])) ++next;
  if (next == rows.to || row - rows.from > next - row) return {column[row], 0};
  const auto time = [&](std::size_t at) { return recording.time[static_cast<Eigen::Index>(at - rows.from)]; };
  const double change = (column[next] - column[row]) / (time(next) - time(row)) * (time(row) - time(rows.from));
  return {column[row] - change, std::abs(change)};
}

void read_initial(const Csv& csv, const Layout& layout, const Rows& rows, Recording& recording) {
  std::map<std::string, double> constants;
  for (const ModelConstant& constant : layout.constants) {
    constants[constant.name] = constant.meta.empty() ? constant.value : recording.constants.at(constant.meta);
  }
  const auto states = static_cast<Eigen::Index>(layout.starts.size());
  recording.initial = recording.initial_scale = Eigen::VectorXd::Zero(states);
  for (Eigen::Index i = 0; i < states; ++i) {
    const StateStart& start = layout.starts[static_cast<std::size_t>(i)];
    if (start.kind == ModelState::Initial::formula) {
      recording.initial[i] = evaluate_once(start.formula, constants);
    } else if (start.kind == ModelState::Initial::column) {
      const std::string why = "with which the state starts (" + start.formula.place + ")";
      const std::vector<double>& column = numbers(csv, start.formula.text, why);
      std::size_t row = rows.from;
      while (row < rows.to && std::isnan(column[row])) ++row;
      if (row == rows.to) {
        throw DiagnoseError(recording.name + ": column " + in_quotes(start.formula.text) + " holds no number, " + why);
      }
      const StartGuess read =
          layout.ode && row > rows.from ? extrapolated(column, row, rows, recording) : StartGuess{column[row], 0};
      recording.initial[i] = read.value;
      recording.initial_scale[i] = read.scale;
    } else {
      const StartGuess guess = guess_start(recording, start);
      recording.initial[i] = guess.value;
      recording.initial_scale[i] = guess.scale;
    }
  }
}

void remark_units(const Csv& csv, const Layout& layout, LoadedRecordings& loaded) {
  for (const ModelInput& input : layout.inputs) {
    if (input.assumed) {
      loaded.remarks.push_back(
          {csv.file, "column " + in_quotes(input.column) + " does not end in a unit and is taken as a pure number"});
    }
  }
}

}  // namespace

LoadedRecordings recordings_of(const Csv& csv, const Layout& layout) {
  LoadedRecordings loaded;
  const std::vector<Rows> parts = sequences(csv, layout);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    Rows rows = parts[i];
    Recording recording;
    recording.name = csv.file + (layout.sequence.empty() ? "" : "#" + std::to_string(i + 1));
    const std::size_t count = rows.to - rows.from, least = layout.skip_rows + (layout.measured_after_step ? 1 : 2);
    if (count < least) {
      throw DiagnoseError(recording.name + ": only " + std::to_string(count) + " row(s) of numbers, but at least " +
                          std::to_string(least) + " are needed" +
                          (layout.skip_rows > 0 ? " (skip_rows = " + std::to_string(layout.skip_rows) + ")" : ""));
    }
    rows.from += layout.skip_rows;
    read_constants(csv, layout, recording);
    read_time(csv, layout, rows, recording);
    read_inputs(csv, layout, rows, recording);
    read_outputs(csv, layout, rows, recording);
    if (layout.measured_after_step) shift_outputs(recording);
    read_initial(csv, layout, rows, recording);
    loaded.recordings.push_back(std::move(recording));
  }
  remark_units(csv, layout, loaded);
  return loaded;
}

LoadedRecordings load_recordings(const std::filesystem::path& path, const Layout& layout) {
  return recordings_of(read_csv(path), layout);
}

}  // namespace diagnose_program

// replay_legs: a log again, through the model as it was and through the corrected one.
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "augmented.hpp"
#include "legs.hpp"

namespace {

struct Row {
  double t = 0;
  std::vector<double> goals, angles;
};

std::vector<Row> read_log(const std::string& file) {
  std::ifstream log(file);
  std::vector<Row> rows;
  std::string line;
  std::getline(log, line);  // names of columns
  while (std::getline(log, line)) {
    std::istringstream cells(line);
    std::vector<double> numbers;
    for (std::string cell; std::getline(cells, cell, ',');) numbers.push_back(std::stod(cell));
    const auto middle = numbers.begin() + 1 + static_cast<std::ptrdiff_t>(numbers.size() / 2);
    rows.push_back({numbers.at(0), {numbers.begin() + 1, middle}, {middle, numbers.end()}});
  }
  if (rows.empty()) throw std::runtime_error(file + ": no rows");
  return rows;
}

// A row's goals hold until the next row. What a simulation does from its start, at rest, is left out.
class Errors {
 public:
  void add(const Row& row, const mjData* data) {
    constexpr double start = 0.5;  // [s]
    if (row.t < start) return;
    for (std::size_t j = 0; j < row.angles.size(); ++j) {
      const double error = data->qpos[j] - row.angles[j];
      squares_ += error * error;
      ++count_;
    }
  }
  double root_mean_square() const { return std::sqrt(squares_ / count_); }

 private:
  double squares_ = 0, count_ = 0;
};

void place(mjData* data, const Row& row) {
  for (std::size_t j = 0; j < row.angles.size(); ++j) data->qpos[j] = row.angles[j];
}

void replay_as_it_was(const std::string& model, const std::vector<Row>& log, Errors& errors) {
  two_legs::Simulation legs(model);
  mjData* data = legs.data.get();
  place(data, log.front());
  for (std::size_t k = 1; k < log.size(); ++k) {
    while (data->time < log[k].t - legs.model->opt.timestep / 2) {
      for (std::size_t j = 0; j < log[k].goals.size(); ++j) data->ctrl[j] = log[k - 1].goals[j];
      mj_step(legs.model.get(), data);
    }
    errors.add(log[k], data);
  }
}

// [replay]
void replay_corrected(const std::string& augmented_xml, const std::vector<Row>& log, Errors& errors) {
  two_legs::Simulation legs(augmented_xml);
  mjModel* model = legs.model.get();
  mjData* data = legs.data.get();
  place(data, log.front());
  surefoot_robot::Extras extras(model);  // of augmented.hpp
  for (std::size_t k = 1; k < log.size(); ++k) {
    while (data->time < log[k].t - model->opt.timestep / 2) {
      extras.before_step(model, data, log[k - 1].goals);  // instead of writing data->ctrl
      mj_step(model, data);
    }
    errors.add(log[k], data);
  }
}
// [replay]

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::cerr << "usage: replay_legs legs.xml augmented.xml LOG...\n";
    return 2;
  }
  try {
    Errors before, after;
    for (int i = 3; i < argc; ++i) {
      const std::vector<Row> log = read_log(argv[i]);
      replay_as_it_was(argv[1], log, before);
      replay_corrected(argv[2], log, after);
    }
    std::printf("%s: %.4f rad\n%s: %.4f rad\n", argv[1], before.root_mean_square(), argv[2], after.root_mean_square());
  } catch (const std::exception& error) {
    std::cerr << "replay_legs: " << error.what() << '\n';
    return 1;
  }
}

#include "measure.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <ctime>
#include <vector>

namespace peers {
namespace {

constexpr double shortest = 0.02;  // [s] of repetitions per measurement

using Clock = std::chrono::steady_clock;

double nanoseconds(Clock::duration duration) { return std::chrono::duration<double, std::nano>(duration).count(); }

/// Mean CPU time of job() [s].
template <class Job>
double repeat(const Job& job) {
  const double start = cpu_seconds();
  double end = start;
  int times = 0;
  for (; end < start + shortest; ++times, end = cpu_seconds()) job();
  return (end - start) / times;
}

double clock_cost() {
  std::vector<double> costs;
  for (int i = 0; i < 1000; ++i) {
    const auto start = Clock::now();
    costs.push_back(nanoseconds(Clock::now() - start));
  }
  return median(costs);
}

double cold_call(Model& model, const std::vector<float>& points, Evictor& evict, std::size_t calls, std::size_t round) {
  std::vector<double> times;
  double out[most_outputs];
  const std::size_t count = points.size() / inputs;
  for (std::size_t call = 0; call < calls; ++call) {
    const std::size_t point = (round * calls + call) * 7 % count;
    const auto* x = &points[point * inputs];
    evict();
    model.keep({x, x + inputs});  // the state a controller asks about is fresh in the cache
    const auto start = Clock::now();
    model.predict_one(0, out);
    times.push_back(nanoseconds(Clock::now() - start));
  }
  return median(times) - clock_cost();
}

}  // namespace

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Evictor::Evictor() {
  const long level_2 = sysconf(_SC_LEVEL2_CACHE_SIZE);
  buffer_.resize(4 * (level_2 > 0 ? static_cast<std::size_t>(level_2) : std::size_t{2} << 20U));
}

void Evictor::operator()() {
  volatile unsigned char* bytes = buffer_.data();
  for (std::size_t i = 0; i < buffer_.size(); i += 64) bytes[i] = static_cast<unsigned char>(bytes[i] + 1);
}

Latency measure(Model& model, const std::vector<float>& points, Evictor& evict, std::size_t cold_calls,
                std::size_t round) {
  const std::size_t count = points.size() / inputs;
  std::vector<double> out(count * most_outputs);
  Latency latency;
  latency.cold = cold_call(model, points, evict, cold_calls, round);
  model.keep(points);
  const double per_point = 1e9 / static_cast<double>(count);
  latency.warm = per_point * repeat([&] {
                   for (std::size_t i = 0; i < count; ++i) model.predict_one(i, &out[i * most_outputs]);
                 });
  latency.batch = per_point * repeat([&] { model.predict_all(out.data()); });
  return latency;
}

Latency median(const std::vector<Latency>& rounds) {
  const auto of = [&](double Latency::* field) {
    std::vector<double> values;
    for (const Latency& round : rounds) values.push_back(round.*field);
    return median(std::move(values));
  };
  return {of(&Latency::warm), of(&Latency::cold), of(&Latency::batch)};
}

}  // namespace peers

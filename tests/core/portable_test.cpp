#include "surefoot/core/portable.hpp"

#include <doctest/doctest.h>

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "surefoot/core/error.hpp"

namespace surefoot {
namespace {

enum class Colour : std::uint8_t { red, green };

struct Inner {
  Eigen::Vector3d fixed = Eigen::Vector3d::Zero();
  Eigen::MatrixXf grown;
  static constexpr auto fields = std::tuple(&Inner::fixed, &Inner::grown);
  bool operator==(const Inner& other) const = default;
};

struct Outer {
  Colour colour = Colour::red;
  bool flag = false;
  std::vector<std::pair<std::string, Inner>> list;
  std::vector<std::vector<double>> nested;
  static constexpr auto fields = std::tuple(&Outer::colour, &Outer::flag, &Outer::list, &Outer::nested);
  bool operator==(const Outer& other) const = default;
};

struct Unlisted {
  double a = 0, b = 0;
};
struct HoldsPointer {
  int* pointer = nullptr;
  static constexpr auto fields = std::tuple(&HoldsPointer::pointer);
};

static_assert(Portable<double> && Portable<Colour> && Portable<std::string> && Portable<Outer>);
static_assert(Portable<std::vector<Eigen::ArrayXd>>);
static_assert(!Portable<int*> && !Portable<std::vector<bool>> && !Portable<Unlisted> && !Portable<HoldsPointer>);
static_assert(!Portable<std::vector<int*>> && !Portable<std::pair<int, Unlisted>>);

Outer example() {
  Outer value{.colour = Colour::green, .flag = true, .list = {}, .nested = {{}, {0.1, -0.0}, {1e300}}};
  value.list.emplace_back("first", Inner{{1, 2, 3}, Eigen::MatrixXf::Constant(2, 3, 0.5F)});
  value.list.emplace_back("", Inner{{4, 5, 6}, Eigen::MatrixXf(0, 7)});
  return value;
}

TEST_CASE("what was put comes back the same") {
  ByteWriter out;
  put(out, example());
  put(out, 7);
  ByteReader in(out.bytes(), "message");
  Outer back;
  int seven = 0;
  take(in, back);
  take(in, seven);
  CHECK(back == example());
  CHECK(back.list[1].second.grown.cols() == 7);
  CHECK(seven == 7);
  in.expect_end();
}

TEST_CASE("bytes that end too early are refused, wherever they end") {
  ByteWriter out;
  put(out, example());
  for (std::size_t size = 0; size < out.size(); ++size) {
    ByteReader in(std::span(out.bytes()).first(size), "message");
    Outer back;
    CHECK_THROWS_AS(take(in, back), CoreError);
  }
}

}  // namespace
}  // namespace surefoot

// Pairs of hand-made proposals.
#include "surefoot/diagnose/selection/pairs.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace surefoot::diagnosis {
namespace {

// A proposal with the strengths 2, 4, ... and these signatures against these open residuals, whose squares add up to 1.
Proposal proposal(const std::string& name, const Eigen::MatrixXd& beyond, const Eigen::VectorXd& rest_of_fit,
                  double least = -10, double most = 10) {
  Effect effect;
  effect.name = name;
  Proposal one;
  one.tried.resize(beyond.cols());
  for (Eigen::Index m = 0; m < beyond.cols(); ++m) {
    effect.parameters.push_back({.name = "strength", .starts = {}, .strength = true});
    one.tried[m] = 2 * static_cast<double>(m + 1);
  }
  one.effect = {std::make_shared<const Effect>(effect), 0, -1, "level", 0};
  one.start = one.tried;
  one.beyond = beyond;
  one.along = beyond.transpose() * rest_of_fit;
  one.least_share = Eigen::VectorXd::Constant(beyond.cols(), least);
  one.most_share = Eigen::VectorXd::Constant(beyond.cols(), most);
  return one;
}

Eigen::MatrixXd column(double a, double b, double c) { return Eigen::Vector3d(a, b, c); }

// Residuals are a small difference of two large signatures, which a third one resembles a little.
const Eigen::VectorXd rest = Eigen::Vector3d(0, 1, 0);

TEST_CASE("two effects that explain little alone are found if they explain much together") {
  const std::vector<Proposal> proposals{proposal("decoy", column(0, -0.4, 1), rest),
                                        proposal("one", column(5, -0.5, 0), rest),
                                        proposal("other", column(5, 0.5, 0), rest)};
  const auto alone = [&](std::size_t i) {
    return proposals[i].along.squaredNorm() / proposals[i].beyond.squaredNorm();
  };
  CHECK(alone(1) < 0.02);
  CHECK(alone(2) < 0.02);
  const auto pairs = propose_pairs(proposals, 2);
  REQUIRE(pairs.size() == 2);
  CHECK(pairs[0].first.effect.effect->name == "one");
  CHECK(pairs[0].second.effect.effect->name == "other");
  CHECK(pairs[0].gain > 0.8);
  CHECK(pairs[0].gain <= 1 + 1e-9);
  CHECK(pairs[1].gain < pairs[0].gain);
}

TEST_CASE("each of a pair starts with its share of what it was screened with") {
  const auto pairs =
      propose_pairs({proposal("one", column(1, 1, 0), rest), proposal("other", column(1, 0, 0), rest)}, 1);
  REQUIRE(pairs.size() == 1);
  CHECK(pairs[0].first.start[0] == doctest::Approx(-2));  // residuals are to be taken away
  CHECK(pairs[0].second.start[0] == doctest::Approx(2));
  CHECK(pairs[0].gain == doctest::Approx(1));
}

TEST_CASE("strengths stay within their limits, and the gain is that of what they may do") {
  const auto pairs =
      propose_pairs({proposal("one", column(0, 1, 0), rest, -0.5, 0), proposal("other", column(1, 0, 0), rest)}, 1);
  REQUIRE(pairs.size() == 1);
  CHECK(pairs[0].first.start[0] == doctest::Approx(-1));
  CHECK(pairs[0].second.start[0] == doctest::Approx(0));
  CHECK(pairs[0].gain == doctest::Approx(0.75));
  const auto never =
      propose_pairs({proposal("one", column(0, 1, 0), rest, 0, 1), proposal("other", column(1, 0, 0), rest)}, 1);
  CHECK(never.at(0).gain == doctest::Approx(0));
}

TEST_CASE("an effect that acts at its full size or not at all keeps the limits of its share") {
  const auto pairs =
      propose_pairs({proposal("fixed", column(0, -1, 1), rest, 1, 1), proposal("other", column(0, 0, 1), rest)}, 1);
  REQUIRE(pairs.size() == 1);
  CHECK(pairs[0].first.start == pairs[0].first.tried);
  CHECK(pairs[0].second.start[0] == doctest::Approx(-2));
  CHECK(pairs[0].gain == doctest::Approx(1));
}

TEST_CASE("each strength of an effect has a share of its own") {
  Eigen::MatrixXd two(3, 2);
  two << 1, 0, 0, 1, 0, 0;
  const auto pairs = propose_pairs({proposal("one", column(1, 0, 0), rest), proposal("two strengths", two, rest)}, 1);
  REQUIRE(pairs.size() == 1);
  CHECK(pairs[0].second.start[1] == doctest::Approx(-4));
  CHECK(pairs[0].gain == doctest::Approx(1));
}

TEST_CASE("nearly collinear signatures, of which neither explains anything, are found at their full size") {
  const double angle = 0.05;  // apart
  const Eigen::MatrixXd one = column(std::cos(angle), std::sin(angle), 0), other = column(std::cos(angle), 0, 0);
  const auto pairs =
      propose_pairs({proposal("one", one, rest, -100, 100), proposal("other", other, rest, -100, 100)}, 1);
  REQUIRE(pairs.size() == 1);
  CHECK(pairs[0].gain == doctest::Approx(1));
}

TEST_CASE("a signature that runs away is in no pair") {
  const auto pairs = propose_pairs({proposal("one", column(1, 1, 0), rest), proposal("other", column(1, 0, 0), rest),
                                    proposal("away", column(1e200, 1e200, 0), rest)},
                                   9);
  REQUIRE(pairs.size() == 1);
  CHECK(pairs[0].first.effect.effect->name == "one");
  CHECK(pairs[0].second.effect.effect->name == "other");
}

TEST_CASE("two forms of one effect at one place are no pair") {
  CHECK(propose_pairs({proposal("a", column(1, 1, 0), rest), proposal("a", column(0, 1, 1), rest)}, 10).empty());
}

TEST_CASE("there are as many pairs as were asked for, the best first, and none of an effect that does nothing") {
  const std::vector<Proposal> proposals{proposal("a", column(1, 1, 0), rest), proposal("nothing", {}, rest.head(0)),
                                        proposal("b", column(0, 1, 1), rest), proposal("c", column(1, 2, 1), rest)};
  const auto pairs = propose_pairs(proposals, 10);
  REQUIRE(pairs.size() == 3);
  for (std::size_t i = 1; i < pairs.size(); ++i) CHECK(pairs[i].gain <= pairs[i - 1].gain);
  for (const ProposedPair& pair : pairs) {
    CHECK(pair.first.effect.effect->name != "nothing");
    CHECK(pair.second.effect.effect->name != "nothing");
  }
  CHECK(propose_pairs(proposals, 1).size() == 1);
  CHECK(propose_pairs({proposals[0]}, 10).empty());
  CHECK(propose_pairs({}, 10).empty());
}

TEST_CASE("a pair is proposed in its best form only, whichever of the two comes first") {
  Proposal one = proposal("one", column(5, -0.5, 0), rest), other = proposal("other", column(5, 0.5, 0), rest),
           another = proposal("another", column(0, -0.4, 1), rest), worse = proposal("one", column(5, -0.5, 1), rest);
  const auto pairs = propose_pairs({worse, other, one, another}, 10);
  const auto holds_both = [](const ProposedPair& pair) {
    const std::string &a = pair.first.effect.effect->name, &b = pair.second.effect.effect->name;
    return (a == "one" && b == "other") || (a == "other" && b == "one");
  };
  CHECK(std::count_if(pairs.begin(), pairs.end(), holds_both) == 1);
  CHECK(holds_both(pairs.front()));
  CHECK(pairs.front().first.beyond.norm() + pairs.front().second.beyond.norm() < 2 * 5.05);  // the better form
  CHECK(pairs.size() == 3);  // and each of them with the third
}

TEST_CASE("tied pairs are of one effect in one form at two places, though a mixed pair may gain more") {
  const auto at = [](Proposal one, int place, const std::string& form) {
    Effect effect = *one.effect.effect;
    effect.form = form;
    one.effect.effect = std::make_shared<const Effect>(effect);
    one.effect.at = place;
    return one;
  };
  const Proposal better = proposal("limit", column(5, -0.5, 0), rest),
                 other = proposal("limit", column(5, 0.5, 0), rest), worse = proposal("limit", column(5, 0.5, 1), rest);
  const std::vector<Proposal> proposals{at(better, 0, "hard"), at(worse, 1, "hard"), at(other, 1, "soft"),
                                        at(proposal("lag", column(0, 1, 0), rest), 0, "hard")};
  CHECK(propose_pairs({proposals[0], proposals[1], proposals[2]}, 9).front().second.effect.effect->form == "soft");
  const auto tied = propose_tied_pairs(proposals, 9);
  REQUIRE(tied.size() == 1);
  CHECK(tied[0].first.effect.effect->form == "hard");
  CHECK(tied[0].second.effect.effect->form == "hard");
  CHECK(tied[0].first.effect.at != tied[0].second.effect.at);
  CHECK(propose_tied_pairs(proposals, 0).empty());
}

}  // namespace
}  // namespace surefoot::diagnosis

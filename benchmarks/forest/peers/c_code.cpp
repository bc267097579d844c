// A constant-leaf forest of this library as C code, compiled with -O2 and loaded.
#include <dlfcn.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "surefoot.hpp"
#include "surefoot/core/binary.hpp"
#include "surefoot/core/executor.hpp"
#include "surefoot/forest/export_c.hpp"
#include "surefoot/forest/extra_trees.hpp"
#include "surefoot_model.hpp"

namespace peers {
namespace {

using Pipe = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

/// The compiled code of one forest, in the address space for as long as this lives.
class Library {
 public:
  explicit Library(const std::string& code) {
    std::string folder = (std::filesystem::temp_directory_path() / "forest_c_XXXXXX").string();
    if (mkdtemp(folder.data()) == nullptr) throw std::runtime_error("no folder for C code could be made");
    surefoot::write_file_atomically(folder + "/forest.c", code);
    const std::string compile =
        "cd '" + folder + "' && cc -O2 -std=c99 -fPIC -c forest.c && cc -shared -o f.so forest.o";
    if (std::system(compile.c_str()) == 0) handle_ = dlopen((folder + "/f.so").c_str(), RTLD_NOW);
    const Pipe pipe(popen(("size '" + folder + "/forest.o' | tail -n 1").c_str(), "r"), pclose);
    const bool sized = pipe && std::fscanf(pipe.get(), "%zu", &bytes_) == 1;
    std::filesystem::remove_all(folder);
    if (handle_ == nullptr || !sized) throw std::runtime_error("C code could not be compiled: " + compile);
  }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;
  ~Library() { dlclose(handle_); }

  template <class Function>
  Function* function(const char* name) const {
    return reinterpret_cast<Function*>(dlsym(handle_, name));
  }
  std::size_t bytes() const { return bytes_; }  // code and tables

 private:
  void* handle_ = nullptr;
  std::size_t bytes_ = 0;
};

/// `Number`: what the function takes, double or whole numbers; `Output`: what it gives.
template <class Number, class Output = double>
class CCode final : public Model {
 public:
  CCode(const std::string& code, std::size_t outputs, double leaves)
      : library_(code),
        predict_(library_.function<void(const Number*, Output*)>("f")),
        value_(library_.function<double(int, std::int32_t)>("f_output")),
        outputs_(outputs),
        leaves_(leaves) {}

  void keep(const std::vector<float>& points) override {
    if constexpr (std::is_same_v<Number, double>) {
      points_.assign(points.begin(), points.end());
    } else {
      const auto convert = library_.function<Number(int, double)>("f_input");
      points_.clear();
      for (std::size_t i = 0; i < points.size(); ++i) {
        points_.push_back(convert(static_cast<int>(i % inputs), static_cast<double>(points[i])));
      }
    }
  }
  void predict_one(std::size_t kept, double* out) override { predict(&points_[kept * inputs], out); }
  void predict_all(double* out) override {
    for (std::size_t i = 0; i < points_.size(); i += inputs, out += outputs_) predict(&points_[i], out);
  }
  double leaves() const override { return leaves_; }
  std::size_t bytes() const override { return library_.bytes(); }

 private:
  void predict(const Number* point, double* out) {
    if constexpr (std::is_same_v<Output, double>) {
      predict_(point, out);
    } else {
      Output whole[most_outputs];
      predict_(point, whole);
      for (std::size_t o = 0; o < outputs_; ++o) out[o] = value_(static_cast<int>(o), whole[o]);
    }
  }

  Library library_;
  void (*predict_)(const Number*, Output*);
  double (*value_)(int, std::int32_t);  // of a whole output
  std::size_t outputs_;
  double leaves_;
  std::vector<Number> points_;
};

template <class Number, class Output = double>
std::unique_ptr<Model> train(const Samples& samples, const Size& size, surefoot::CDescent descent) {
  if (samples.outputs != 1) throw std::invalid_argument("C code of 1 output only");
  const auto forest = surefoot::train_extra_trees(
      data_of<1>(samples), {.trees = size.trees, .min_leaf = size.min_leaf, .max_leaves = size.leaves},
      surefoot::Threads(size.threads), 1);
  const auto thresholds = std::is_same_v<Number, double> ? surefoot::CThreshold::float32 : surefoot::CThreshold::int16;
  const std::string code = surefoot::export_c(forest, {.function = "f",
                                                       .descent = descent,
                                                       .thresholds = thresholds,
                                                       .whole_outputs = !std::is_same_v<Output, double>});
  return std::make_unique<CCode<Number, Output>>(
      code, samples.outputs, static_cast<double>(forest.leaves()) / static_cast<double>(forest.trees()));
}

}  // namespace

bool have_c_compiler() {
  static const bool found = std::system("cc --version > /dev/null 2>&1 && size --version > /dev/null 2>&1") == 0;
  return found;
}

std::unique_ptr<Model> train_c_tables(const Samples& samples, const Size& size) {
  return train<double>(samples, size, surefoot::CDescent::tables);
}
std::unique_ptr<Model> train_c_tables_int16(const Samples& samples, const Size& size) {
  return train<std::int16_t>(samples, size, surefoot::CDescent::tables);
}
std::unique_ptr<Model> train_c_whole(const Samples& samples, const Size& size) {
  return train<std::int16_t, std::int32_t>(samples, size, surefoot::CDescent::tables);
}
std::unique_ptr<Model> train_c_branches(const Samples& samples, const Size& size) {
  return train<double>(samples, size, surefoot::CDescent::branches);
}

}  // namespace peers

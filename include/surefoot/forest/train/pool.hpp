// Things that jobs on several threads use one after the other, such as memory worth keeping.
#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace surefoot::detail {

/// Makes a T when all others are in use: never more than jobs run at once. Must outlive what is borrowed.
template <class T>
class Pool {
 public:
  struct GiveBack {
    Pool* pool = nullptr;
    void operator()(T* thing) const { pool->take_back(std::unique_ptr<T>(thing)); }
  };
  using Borrowed = std::unique_ptr<T, GiveBack>;

  /// One of the things, as its last user left it.
  Borrowed borrow() {
    const std::scoped_lock lock(mutex_);
    if (idle_.empty()) return Borrowed(new T(), GiveBack{this});
    Borrowed thing(idle_.back().release(), GiveBack{this});
    idle_.pop_back();
    return thing;
  }

 private:
  void take_back(std::unique_ptr<T> thing) {
    const std::scoped_lock lock(mutex_);
    idle_.push_back(std::move(thing));
  }

  std::mutex mutex_;
  std::vector<std::unique_ptr<T>> idle_;
};

}  // namespace surefoot::detail

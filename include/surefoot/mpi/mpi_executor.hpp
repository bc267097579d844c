// The processes of an MPI program as one executor. Each of them runs the same program with the same seed and does its
// share of the jobs; what the jobs found is then made known to all, so that every process goes on from the same state.
// The results are those of one process, bit for bit.
//
//   int main(int argc, char** argv) {
//     const surefoot::MpiSession session(argc, argv);
//     const surefoot::MpiExecutor executor(MPI_COMM_WORLD);
//     const auto result = surefoot::rfpi(problem, options, executor, /*seed*/ 1);  // mpirun -n 8 ./program
//     surefoot::once(executor, [&] { surefoot::save_policy("my.policy", result.policy); });
//   }
//
// Cost of a run over P processes: an all-gather of 32 bytes per process and one of what the jobs wrote, about
// log2(P) * latency + bytes / bandwidth; memory for all of these bytes in each process.
// The umbrella does not include this header: link surefoot::mpi.
#pragma once

#include <mpi.h>

#include <chrono>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <limits>
#include <mutex>
#include <numeric>
#include <span>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "surefoot/core/binary.hpp"
#include "surefoot/core/error.hpp"
#include "surefoot/core/executor.hpp"

namespace surefoot {

/// What an executor has done so far in this process: tells how well a program scales.
struct MpiUse {
  std::uint64_t rounds = 0;     // runs whose results were exchanged
  std::uint64_t bytes = 0;      // of results, of all processes together
  double job_seconds = 0;       // at work on jobs, wall clock [s]
  double exchange_seconds = 0;  // packing, waiting for the others, and exchanging [s]
};

/// Build and destroy it in all processes of the communicator, before MPI ends. Use it from one thread at a time, the
/// one that initialised MPI; inside its own jobs it works in their process alone.
class MpiExecutor {
 public:
  /// Each process works with `threads` threads; 0 means as many as the machine has.
  explicit MpiExecutor(MPI_Comm processes, std::size_t threads = 1) : threads_(threads) {
    MPI_Comm_dup(processes, &communicator_);  // so that nobody else's messages meet ours
    int rank = 0, size = 1;
    MPI_Comm_rank(communicator_, &rank);
    MPI_Comm_size(communicator_, &size);
    rank_ = static_cast<std::size_t>(rank);
    processes_ = static_cast<std::size_t>(size);
    MPI_Type_contiguous(block, MPI_BYTE, &block_type_);
    MPI_Type_commit(&block_type_);
  }
  ~MpiExecutor() {
    MPI_Type_free(&block_type_);
    MPI_Comm_free(&communicator_);
  }
  MpiExecutor(const MpiExecutor&) = delete;
  MpiExecutor& operator=(const MpiExecutor&) = delete;

  std::size_t processes() const { return processes_; }
  std::size_t rank() const { return rank_; }  // of this process, from 0
  std::size_t width() const { return processes_ * threads_.width(); }
  const MpiUse& use() const { return use_; }

  /// Every process does all jobs.
  template <std::invocable<std::size_t> Job>
  bool run(std::size_t count, Job&& job, std::stop_token stop = {}) const {
    const bool can_stop = stop.stop_possible();
    Outcome own = attempt(0, 1, count, job, std::move(stop));
    if (inside_job_ || !can_stop) {  // jobs fail alike everywhere
      if (own.error) std::rethrow_exception(own.error);
      return own.complete;
    }
    return agree(own, count, 0).complete;
  }

  /// Each process does its jobs; see Distributed.
  template <std::invocable<std::size_t> Job, class Pack, class Unpack>
  bool run_apart(std::size_t count, Job&& job, std::stop_token stop, const Pack& pack, const Unpack& unpack) const {
    if (inside_job_) return run(count, std::forward<Job>(job), std::move(stop));
    const auto began = Clock::now();
    Outcome own = attempt(rank_, processes_, count, job, std::move(stop));
    const auto worked = Clock::now();
    use_.job_seconds += std::chrono::duration<double>(worked - began).count();
    ByteWriter mine;
    if (own.complete) {
      for (std::size_t i = rank_; i < count; i += processes_) pack(i, mine);
    }
    const Agreement agreed = agree(own, count, mine.size());
    if (!agreed.complete) return false;
    const Received all = exchange(std::move(mine).bytes(), agreed.bytes);
    for (std::size_t from = 0; from < processes_; ++from) {
      if (from == rank_) continue;
      ByteReader in(std::span(all.bytes).subspan(all.from[from], agreed.bytes[from]),
                    "what process " + std::to_string(from) + " sent");
      for (std::size_t i = from; i < count; i += processes_) unpack(i, in);
      in.expect_end();
    }
    ++use_.rounds;
    use_.bytes += std::accumulate(agreed.bytes.begin(), agreed.bytes.end(), std::uint64_t{0});
    use_.exchange_seconds += std::chrono::duration<double>(Clock::now() - worked).count();
    return true;
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  static constexpr int block = 64;  // [bytes]; MPI counts in int, so that 128 GB can be sent at once

  // How this process's jobs went.
  struct Outcome {
    bool complete = false;
    std::size_t error_index = none;  // the lowest that threw
    std::exception_ptr error;
  };

  // What all processes know of each other's jobs.
  struct Agreement {
    bool complete = false;
    std::vector<std::size_t> bytes;  // to be sent, by process
  };

  // Marks the thread as one that is inside a job.
  struct Inside {
    bool before = std::exchange(inside_job_, true);
    Inside() = default;
    ~Inside() { inside_job_ = before; }
    Inside(const Inside&) = delete;
    Inside& operator=(const Inside&) = delete;
  };

  // Jobs first, first + stride, ... on the threads of this process.
  template <class Job>
  Outcome attempt(std::size_t first, std::size_t stride, std::size_t count, Job& job, std::stop_token stop) const {
    Outcome outcome;
    std::mutex keeping;
    const auto guarded = [&](std::size_t k) {
      const Inside inside;
      const std::size_t i = first + k * stride;
      try {
        job(i);
      } catch (...) {
        const std::scoped_lock lock(keeping);
        if (i < outcome.error_index) {
          outcome.error_index = i;
          outcome.error = std::current_exception();
        }
        throw;
      }
    };
    const std::size_t own = count > first ? (count - first + stride - 1) / stride : 0;
    try {
      outcome.complete = own == 0 ? count == 0 || !stop.stop_requested() : threads_.run(own, guarded, stop);
    } catch (...) {
      if (!outcome.error) throw;  // no job's: threads could not be started
    }
    return outcome;
  }

  // Tells the others how it went here. If a job failed anywhere, throws that exception everywhere.
  Agreement agree(const Outcome& own, std::size_t count, std::size_t bytes) const {
    struct Word4 {
      std::uint64_t count, complete, error_index, bytes;
    };
    const Word4 mine{count, own.complete ? 1U : 0U, own.error_index, bytes};
    std::vector<Word4> all(processes_);
    MPI_Allgather(&mine, 4, MPI_UINT64_T, all.data(), 4, MPI_UINT64_T, communicator_);
    Agreement agreed{.complete = true, .bytes = {}};
    std::size_t failed = 0, same = 0;
    for (std::size_t from = 0; from < processes_; ++from) {
      agreed.complete = agreed.complete && all[from].complete != 0;
      agreed.bytes.push_back(all[from].bytes);
      if (all[from].error_index < all[failed].error_index) failed = from;
      if (all[from].count == all[0].count) ++same;
    }
    if (all[failed].error_index != none) pass_on(own.error, failed);
    if (agreed.complete && same != processes_) {
      throw CoreError("MpiExecutor: the processes ask for different numbers of jobs, " + std::to_string(count) +
                      " in process " + std::to_string(rank_) +
                      ": they must run the same program with the same seed and files");
    }
    return agreed;
  }

  // Throws the exception of process `failed`: there as it is, elsewhere as an Error or a runtime_error of its words.
  [[noreturn]] void pass_on(const std::exception_ptr& own, std::size_t failed) const {
    std::string words = "an exception that is no std::exception";
    std::uint64_t header[2] = {0, 0};  // whether it is an Error, length of its words
    if (rank_ == failed) {
      try {
        std::rethrow_exception(own);
      } catch (const Error& error) {
        words = error.what();
        header[0] = 1;
      } catch (const std::exception& error) {
        words = error.what();
      } catch (...) {
      }
      header[1] = words.size();
    }
    const int root = static_cast<int>(failed);
    MPI_Bcast(header, 2, MPI_UINT64_T, root, communicator_);
    words.resize(static_cast<std::size_t>(header[1]));
    MPI_Bcast(words.data(), static_cast<int>(words.size()), MPI_CHAR, root, communicator_);
    if (rank_ == failed) std::rethrow_exception(own);
    if (header[0] != 0) throw CoreError(words);
    throw std::runtime_error(words);
  }

  // What every process sends, one behind the other; `from[p]` is where that of process p lies.
  struct Received {
    Bytes bytes;
    std::vector<std::size_t> from;
  };

  // `sizes`: how many bytes each process sends.
  Received exchange(Bytes mine, const std::vector<std::size_t>& sizes) const {
    std::vector<int> counts, places;
    std::size_t total = 0;
    for (const std::size_t size : sizes) {
      places.push_back(static_cast<int>(total));
      counts.push_back(static_cast<int>((size + block - 1) / block));
      total += static_cast<std::size_t>(counts.back());
    }
    if (total > std::numeric_limits<int>::max()) {
      throw CoreError("MpiExecutor: jobs wrote more than 128 GB, which cannot be sent at once: use fewer samples");
    }
    Received all{Bytes(total * block), {}};
    for (const int place : places) all.from.push_back(static_cast<std::size_t>(place) * block);
    mine.resize(static_cast<std::size_t>(counts[rank_]) * block);
    MPI_Allgatherv(mine.data(), counts[rank_], block_type_, all.bytes.data(), counts.data(), places.data(), block_type_,
                   communicator_);
    return all;
  }

  Threads threads_;
  MPI_Comm communicator_ = MPI_COMM_NULL;
  MPI_Datatype block_type_ = MPI_DATATYPE_NULL;
  std::size_t rank_ = 0;
  std::size_t processes_ = 1;
  mutable MpiUse use_;
  static inline thread_local bool inside_job_ = false;
};
static_assert(Distributed<MpiExecutor>);

}  // namespace surefoot

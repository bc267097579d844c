// The command line of a program of subcommands. What reads it is CLI11, behind this and compiled once: a program that
// includes CLI11 itself pays three seconds for it in every file.
#pragma once

#include <functional>
#include <initializer_list>
#include <memory>
#include <string>

namespace example {

/// What a value must be. Made by between(), one_of() and existing_file().
class Check {
 public:
  struct Validator;
  explicit Check(std::shared_ptr<const Validator> validator);
  const Validator& validator() const { return *validator_; }

 private:
  std::shared_ptr<const Validator> validator_;
};

/// From `least` to `most`, both included.
Check between(double least, double most);
Check between(int least, int most);

Check one_of(std::initializer_list<const char*> names);
Check one_of(std::initializer_list<int> numbers);

Check existing_file();

/// An option of a command; belongs to the command. Each function returns the option, so that they chain.
class Option {
 public:
  struct Impl;
  explicit Option(std::unique_ptr<Impl> impl);
  ~Option();

  Option* check(const Check& allowed);
  Option* required();
  /// --help shows the value that the variable has now.
  Option* capture_default_str();
  /// Values of a list may stand in one word, parted by this.
  Option* delimiter(char between_values);
  Option* expected(int values);
  Option* expected(int least_values, int most_values);
  Option* needs(const std::string& other);
  Option* needs(Option* other);
  Option* excludes(Option* other);

 private:
  std::unique_ptr<Impl> impl_;
};

/// A program or a subcommand of one. Options write into variables that must live as long as the command.
class Command {
 public:
  struct Impl;
  Command(const std::string& what, const std::string& name);  // a program
  explicit Command(std::unique_ptr<Impl> impl);
  ~Command();

  const std::string& name() const;

  /// `names` as in "--out" or "-o,--out"; without dashes it is a positional argument. Value: a number, string, path,
  /// optional number, or a vector or array of these (command.cpp lists them).
  template <class Value>
  Option* add_option(const std::string& names, Value& value, const std::string& help = "");
  Option* add_flag(const std::string& names, bool& value, const std::string& help);
  Option* add_flag_callback(const std::string& names, std::function<void()> when_given, const std::string& help);

  Command* add_subcommand(const std::string& name, const std::string& what);
  /// Exactly so many.
  void require_subcommand(int count);
  /// Runs once the command line has been read.
  void callback(std::function<void()> run);
  /// What --help ends with.
  void footer(const std::string& text);

  Impl& impl() { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

/// From the command line to the exit code: 0 done, 1 a defect of the program, 2 bad options or files, 130 stopped by
/// Ctrl-C. Parses, which runs the subcommand, and tells an error in one line; `when_interrupted` is told after Ctrl-C.
int run_program(Command& program, int argc, char** argv, const std::string& when_interrupted = "");

}  // namespace example

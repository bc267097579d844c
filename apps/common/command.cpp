#include "command.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <deque>
#include <exception>
#include <filesystem>
#include <iostream>
#include <optional>
#include <utility>
#include <vector>

#include "surefoot/core/error.hpp"
#include "usage_error.hpp"
#include "version_text.hpp"

namespace example {

struct Check::Validator {
  CLI::Validator validator;
};

Check::Check(std::shared_ptr<const Validator> validator) : validator_(std::move(validator)) {}

namespace {

Check check_by(CLI::Validator validator) {
  return Check(std::make_shared<const Check::Validator>(Check::Validator{std::move(validator)}));
}

}  // namespace

Check between(double least, double most) { return check_by(CLI::Range(least, most)); }
Check between(int least, int most) { return check_by(CLI::Range(least, most)); }
Check one_of(std::initializer_list<const char*> names) {
  return check_by(CLI::IsMember(std::vector<std::string>(names.begin(), names.end())));
}
Check one_of(std::initializer_list<int> numbers) { return check_by(CLI::IsMember(std::vector<int>(numbers))); }
Check existing_file() { return check_by(CLI::ExistingFile); }

struct Option::Impl {
  CLI::Option* option;
};

Option::Option(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Option::~Option() = default;

Option* Option::check(const Check& allowed) {
  impl_->option->check(allowed.validator().validator);
  return this;
}

Option* Option::required() {
  impl_->option->required();
  return this;
}

Option* Option::capture_default_str() {
  impl_->option->capture_default_str();
  return this;
}

Option* Option::delimiter(char between_values) {
  impl_->option->delimiter(between_values);
  return this;
}

Option* Option::expected(int values) {
  impl_->option->expected(values);
  return this;
}

Option* Option::expected(int least_values, int most_values) {
  impl_->option->expected(least_values, most_values);
  return this;
}

Option* Option::needs(const std::string& other) {
  impl_->option->needs(other);
  return this;
}

Option* Option::needs(Option* other) {
  impl_->option->needs(other->impl_->option);
  return this;
}

Option* Option::excludes(Option* other) {
  impl_->option->excludes(other->impl_->option);
  return this;
}

struct Command::Impl {
  std::unique_ptr<CLI::App> program;  // null of a subcommand, which belongs to its program
  CLI::App* app;
  std::deque<Option> options{};
  std::deque<Command> subcommands{};

  Option* added(CLI::Option* option) {
    return &options.emplace_back(std::make_unique<Option::Impl>(Option::Impl{option}));
  }
};

Command::Command(const std::string& what, const std::string& name)
    : impl_(std::make_unique<Impl>(Impl{std::make_unique<CLI::App>(what, name), nullptr})) {
  impl_->app = impl_->program.get();
}
Command::Command(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Command::~Command() = default;

const std::string& Command::name() const { return impl_->app->get_name(); }

template <class Value>
Option* Command::add_option(const std::string& names, Value& value, const std::string& help) {
  return impl_->added(impl_->app->add_option(names, value, help));
}

// The kinds of values that the programs read.
template Option* Command::add_option(const std::string&, int&, const std::string&);
template Option* Command::add_option(const std::string&, std::uint8_t&, const std::string&);
template Option* Command::add_option(const std::string&, std::uint32_t&, const std::string&);
template Option* Command::add_option(const std::string&, std::uint64_t&, const std::string&);
template Option* Command::add_option(const std::string&, double&, const std::string&);
template Option* Command::add_option(const std::string&, std::string&, const std::string&);
template Option* Command::add_option(const std::string&, std::filesystem::path&, const std::string&);
template Option* Command::add_option(const std::string&, std::optional<double>&, const std::string&);
template Option* Command::add_option(const std::string&, std::vector<int>&, const std::string&);
template Option* Command::add_option(const std::string&, std::vector<std::uint32_t>&, const std::string&);
template Option* Command::add_option(const std::string&, std::vector<std::uint64_t>&, const std::string&);
template Option* Command::add_option(const std::string&, std::vector<double>&, const std::string&);
template Option* Command::add_option(const std::string&, std::array<double, 2>&, const std::string&);
template Option* Command::add_option(const std::string&, std::array<int, 3>&, const std::string&);
template Option* Command::add_option(const std::string&, std::vector<std::string>&, const std::string&);
template Option* Command::add_option(const std::string&, std::vector<std::filesystem::path>&, const std::string&);

Option* Command::add_flag(const std::string& names, bool& value, const std::string& help) {
  return impl_->added(impl_->app->add_flag(names, value, help));
}

Option* Command::add_flag_callback(const std::string& names, std::function<void()> when_given,
                                   const std::string& help) {
  return impl_->added(impl_->app->add_flag_callback(names, std::move(when_given), help));
}

Command* Command::add_subcommand(const std::string& name, const std::string& what) {
  CLI::App* app = impl_->app->add_subcommand(name, what);
  return &impl_->subcommands.emplace_back(std::make_unique<Impl>(Impl{nullptr, app}));
}

void Command::require_subcommand(int count) { impl_->app->require_subcommand(count); }
void Command::callback(std::function<void()> run) { impl_->app->callback(std::move(run)); }
void Command::footer(const std::string& text) { impl_->app->footer(text); }

int run_program(Command& program, int argc, char** argv, const std::string& when_interrupted) {
  CLI::App& app = *program.impl().app;
  const auto fail = [&](std::string message, int code) {
    std::replace(message.begin(), message.end(), '\n', ' ');
    if (!message.empty()) std::cerr << program.name() << ": " << message << '\n';
    return code;
  };
  app.set_version_flag("--version", version_text(program.name()));
  try {
    app.parse(argc, argv);
    return EXIT_SUCCESS;
  } catch (const CLI::Success& help_or_version) {
    return app.exit(help_or_version);
  } catch (const CLI::ParseError& error) {
    return fail(std::string(error.what()) + "; see " + program.name() + " --help", 2);
  } catch (const Interrupted&) {
    return fail(when_interrupted, 130);
  } catch (const surefoot::Error& error) {
    return fail(error.what(), 2);
  } catch (const std::exception& error) {
    return fail(error.what(), EXIT_FAILURE);
  }
}

}  // namespace example

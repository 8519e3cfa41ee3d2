// validation/app/output.hpp: what the command writes, and where.
#pragma once

#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace plumbline::app {

/// A file that a verb was asked to write.
struct Destination {
  std::string option;     // "-o", "--json"
  std::string path;       // empty: not asked for
  std::string extension;  // that the name must end in, in any case; empty: text, which may also go to "-" or
                          // into a device or a pipe
};

/// Refuses, before the work, what could not be written at the end: a path that cannot be written, a wrong
/// extension, a picture or a baked file for standard output, two outputs with one destination.
/// @throws InputError
void require_destinations(std::initializer_list<Destination> destinations);

/// Writes text to a file by rename, into a device or pipe as it is, or to standard output for "-". A reader
/// that closes the pipe early (`| head`) is no error. @throws InputError when the text cannot be written
void write_output(const std::string& destination, std::string_view text);

/// Writes JSON when a destination was given. Numbers JSON cannot hold become the strings "nan", "inf",
/// "-inf".
void write_json(const std::string& destination, const nlohmann::json& json);
/// A number as JSON; see write_json.
[[nodiscard]] nlohmann::json number(double value);

/// A line for people on standard output beside the real output; whether anybody can read it does not matter.
void say(const std::string& line);
/// A line on standard error, "plumbline: " in front.
void complain(const std::string& line);
/// complain("warning: …")
void warn(const std::string& message);

/// Keeps files that are opened later from taking the number of a standard stream that the caller closed, and
/// makes a closed pipe an error of the write instead of the end of the process. Call first.
void prepare_standard_streams();

}  // namespace plumbline::app

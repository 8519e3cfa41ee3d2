// validation/report/report.hpp: a report as a value, and the three forms it is written in.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "reference/image/image.hpp"
#include "validation/checks/finding.hpp"

namespace plumbline::report {

/// One number a reader should take away.
struct Headline {
  std::string label;    // "error under the band-limited light"
  std::string value;    // "0.31 % ± 0.04 %"
  std::string caption;  // what is good, in words
};

/// Several images of one view, linear RGB and of one size, shown side by side and under a slider (any two of
/// them), with exposure control.
struct Gallery {
  struct Entry {
    std::string label;   // "path traced", "PRT, 5 bands"
    image::Image image;  // linear
  };
  struct ErrorMap {
    std::string label;
    image::Image8 image;  // already colour mapped
    double scale = 0.0;   // value of the brightest colour
    std::string unit;     // "radiance", "% of the mean"
    image::Image8 ramp =
        {};  // one row, the colours from 0 to `scale`; empty = the scale is given in words only
  };
  std::string title;
  std::string caption;
  std::vector<Entry> entries;
  std::vector<ErrorMap> errors;
  float exposure_stops = 0.0F;  // the pictures are first shown at
};

struct Series {
  std::string name;
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> y_low;  // empty, or one per point: the interval
  std::vector<double> y_high;
  bool is_reference = false;  // a theoretical curve: dashed, no markers
  bool is_bars = false;       // a histogram: x are the middles of bins of equal width
};
struct Chart {
  std::string title;
  std::string caption;  // says what is good
  std::string x_label;
  std::string y_label;
  bool is_x_log = false;
  bool is_y_log = false;
  std::vector<Series> series;
};

/// Many measured values of one kind, one above the other on one axis, each with its interval and the band it should
/// lie in: a forest plot. Readable without JavaScript.
struct Forest {
  struct Row {
    std::string name;
    double value = 0.0;
    double low = 0.0;
    double high = 0.0;
    checks::Verdict verdict = checks::Verdict::inconclusive;
  };
  std::string title;
  std::string caption;
  std::string unit;   // "%"
  double band = 0.0;  // the axis shows +- 1.6 of it; > 0
  std::vector<Row> rows;
};

struct Table {
  std::string title;
  std::string caption;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

struct Report {
  std::string title;
  std::string summary;  // a sentence or two under the title
  std::string date;     // ISO 8601
  std::string version;
  std::string command;                                        // reproduces the report
  std::map<std::string, std::string> machine;                 // "cpu", "threads", "memory", "os", "compiler"
  std::vector<std::pair<std::string, std::string>> settings;  // seeds, samples, significance
  std::vector<Headline> headlines;
  std::vector<Gallery> galleries;
  std::vector<Forest> forests;
  std::vector<Chart> charts;
  std::vector<Table> tables;
  std::vector<checks::Finding> findings;
  nlohmann::json data = nlohmann::json::object();  // extra numbers for the JSON form
};

/// The finding's own verdict, except that a pass with a NaN among its numbers, or with an infinite measured
/// value, counts as fail: such a check was not able to fail.
[[nodiscard]] checks::Verdict verdict(const checks::Finding& finding);
/// fail if any finding fails, else inconclusive if any is or there are none, else pass.
[[nodiscard]] checks::Verdict verdict(const Report& report);

/// |test - reference| as metrics::heat_map draws it, with the colours of its scale.
/// @throws InputError as metrics::heat_map does.
[[nodiscard]] Gallery::ErrorMap error_map(std::string label, const image::Image& reference,
                                          const image::Image& test, double scale, std::string unit);

/// Everything but the pictures; keys: title, summary, verdict, date, version, command, machine, settings,
/// headlines, galleries, forests, charts, tables, findings, data. Settings are an object; the values of a repeated
/// name are joined by ", ". Bytes that are no UTF-8 become U+FFFD. Non-finite numbers become the strings
/// "nan", "inf", "-inf".
[[nodiscard]] nlohmann::json to_json(const Report& report);
/// JUnit XML: one test case per finding, family = class name; inconclusive counts as skipped with its reason.
[[nodiscard]] std::string to_junit(const Report& report);
/// One self-contained page that opens offline: no network, pictures inside, radiance to one part in 1477 for
/// exposure and read-out.
/// @throws InputError when a picture's pixels are not width * height.
[[nodiscard]] std::string to_html(const Report& report);

}  // namespace plumbline::report

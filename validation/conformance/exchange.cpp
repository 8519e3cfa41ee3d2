#include "validation/conformance/exchange.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "reference/base/atomic_file.hpp"
#include "reference/base/error.hpp"
#include "reference/base/text.hpp"
#include "reference/image/exr.hpp"
#include "reference/scene/text.hpp"
#include "validation/checks/sh_checks.hpp"
#include "validation/conformance/diagnosis.hpp"
#include "validation/conformance/truths.hpp"

namespace fs = std::filesystem;

namespace plumbline::conformance {
namespace {

using nlohmann::json;
using Table = std::vector<Values>;

constexpr int kWidth = 64;
constexpr int kHeight = 32;

/// What every question is made from: the same numbers for asking and judging.
struct Questions {
  int bands = 0;
  std::vector<Vec3d> directions = checks::probe_directions();
  std::vector<glm::dmat3> rotations = truths::rotations();
  Values a;  // coefficients of one channel, with a mean
  Values b;
};

Questions questions(int bands) {
  Questions q;
  q.bands = bands;
  const auto count = static_cast<std::size_t>(bands * bands);
  q.a = truths::some_values(count, 1);
  q.b = truths::some_values(count, 2);
  q.a[0] = 4.0;
  return q;
}

image::Image sky_image() {
  image::Image image = image::make_image(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      image.at(x, y) =
          Rgb(static_cast<float>(truths::polynomial_sky(truths::lat_long_centre(kWidth, kHeight, x, y))));
  return image;
}

std::string csv(const Table& table) {
  std::string text;
  for (const Values& row : table) {
    for (std::size_t i = 0; i < row.size(); ++i) text += fmt::format("{}{:.17g}", i > 0 ? "," : "", row[i]);
    text += '\n';
  }
  return text;
}

Table rows_of(const std::vector<Vec3d>& directions) {
  Table table;
  for (const Vec3d& d : directions) table.push_back({d.x, d.y, d.z});
  return table;
}
Table rows_of(const std::vector<glm::dmat3>& rotations) {
  Table table;
  for (const glm::dmat3& r : rotations) {
    table.emplace_back();
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column) table.back().push_back(r[column][row]);
  }
  return table;
}

std::string readme(int bands) {
  return fmt::format(
      "Questions of plumbline conform for {0} bands ({1} coefficients).\n"
      "Answer any of them: write the CSV file named, one row of numbers separated by commas for each row of "
      "the\n"
      "question, no header, 9 digits or more. Then run: plumbline conform --import THIS-FOLDER\n\n"
      "answer-basis.csv          {1} basis functions at each direction (x,y,z) of directions.csv\n"
      "answer-projection.csv     {1} rows r,g,b: coefficients of the radiance of sky.exr "
      "(latitude-longitude,\n"
      "                          centre +X, u = 3/4 is +Z, top +Y, linear)\n"
      "answer-rotation.csv       {1} coefficients of a.csv turned by each matrix (row-major) of "
      "rotations.csv\n"
      "answer-product.csv        one row: {1} coefficients of the product of a.csv and b.csv\n"
      "answer-irradiance.csv     irradiance E (not E/pi) of a.csv at each normal of directions.csv, one "
      "number a row\n"
      "answer-directional.csv    {1} coefficients of a light of irradiance 1 from each direction of "
      "directions.csv\n\n"
      "Write your convention into convention.json; 0 is unknown. The numbers are those of "
      "plumbline_conformance.h:\n"
      "index_order 1 l(l+1)+m, 2 descending m, 3 x y z first, 4 m = 0, 1, -1, ...; sign 1 Condon-Shortley, 2 "
      "without;\n"
      "norm 1 orthonormal, 2 4 pi, 3 semi-Schmidt, 4 unnormalised, 5 bare polynomials; axes: yours in world "
      "axes;\n"
      "quantity 1 radiance, 2 /pi, 3 /4 pi, 4 irradiance, 5 irradiance/pi, 6 irradiance/pi^2.\n"
      "a.csv and b.csv are in Plumbline's convention: 1, 1, 1, [1,2,3], 1.\n",
      bands, bands * bands);
}

// ---------------------------------------------------------------- answers
[[noreturn]] void refuse(const fs::path& file, std::size_t line, const std::string& reason) {
  throw InputError(fmt::format("{}:{}: {}", file.string(), line, reason));
}

/// None: there is no such file.
std::optional<Table> read_answer(const fs::path& file, std::size_t rows, std::size_t columns) {
  if (!fs::exists(file)) return std::nullopt;
  const std::string text = read_file(file);
  Table table;
  std::size_t number = 0;
  for (const std::string_view line : split(text, '\n')) {
    ++number;
    if (line.find_first_not_of(" \t\r") == std::string_view::npos) continue;
    Values row;
    for (std::string_view word : split(line, ',')) {
      while (!word.empty() && (word.back() == '\r' || word.back() == ' ')) word.remove_suffix(1);
      while (!word.empty() && word.front() == ' ') word.remove_prefix(1);
      const std::optional<double> value = scene::parse_number(word);
      if (!value) refuse(file, number, "expected numbers separated by commas");
      row.push_back(*value);
    }
    if (row.size() != columns)
      refuse(file, number, fmt::format("expected {} numbers, got {}", columns, row.size()));
    table.push_back(std::move(row));
  }
  if (table.size() != rows) refuse(file, number, fmt::format("expected {} rows, got {}", rows, table.size()));
  return table;
}

plumbline_convention read_convention(const fs::path& file) {
  plumbline_convention convention{};
  convention.layout = PLUMBLINE_LAYOUT_INTERLEAVED;
  if (!fs::exists(file)) return convention;
  try {
    const json value = json::parse(read_file(file));
    convention.index_order = value.at("index_order");
    convention.sign = value.at("sign");
    convention.norm = value.at("norm");
    convention.quantity = value.at("quantity");
    for (std::size_t k = 0; k < 3; ++k) convention.axes[k] = value.at("axes").at(k);
  } catch (const json::exception& error) {
    throw InputError(fmt::format("{}: {}", file.string(), one_line(error.what())));
  }
  if (const std::string fault = fault_of(convention); !fault.empty())
    throw InputError(fmt::format("{}: {}", file.string(), fault));
  return convention;
}

/// Answers are judged as single precision: they may come from any engine, as text.
constexpr double kEpsilon = 0x1p-23;

struct Question {
  const char* operation;
  const char* file;
  std::size_t rows;
  std::size_t columns;
  std::function<Pairs(const Table&)> compare;
  double allowance;  // relative to the largest expected value
};

Line missing(const Question& question) {
  Line line;
  checks::Finding& f = line.judged.finding;
  f.family = question.operation;
  f.name = "answer";
  f.verdict = checks::Verdict::inconclusive;
  f.detail = fmt::format("no {}: not answered", question.file);
  return line;
}

Line judged_answer(const Question& question, const Table& table, int bands) {
  const Pairs pairs = question.compare(table);
  Line line;
  line.judged.bands = bands;
  checks::Finding& f = line.judged.finding;
  f.family = question.operation;
  f.name = fmt::format("answer / {} bands", bands);
  f.measured = pairs.error(right_ruler());
  f.bound = question.allowance * std::max(1.0, pairs.scale());
  f.source = "Single precision; a texel's size for images";
  f.verdict = right_ruler().accepts(f.measured, f.bound) ? checks::Verdict::pass : checks::Verdict::fail;
  if (f.verdict == checks::Verdict::pass) return line;
  const bool is_single = pairs.expected.front().size() == 1;
  Values expected;
  Values measured;
  for (std::size_t k = 0; k < pairs.expected.size() && is_single; ++k) {
    expected.push_back(pairs.expected[k][0]);
    measured.push_back(pairs.measured[k][0]);
  }
  line.judged.cause =
      is_single ? diagnose_values(expected, measured, 1e-3)
                : diagnose({bands, pairs.expected, pairs.measured, std::max(1e-4, question.allowance)});
  f.detail = line.judged.cause;
  return line;
}

Values channel(const Table& rows, std::size_t which) {
  Values result;
  for (const Values& row : rows) result.push_back(row[which]);
  return result;
}

double irradiance(const Values& coefficients, const Vec3d& normal) {
  const Values y = truths::basis(
      static_cast<int>(std::lround(std::sqrt(static_cast<double>(coefficients.size())))), normal);
  double sum = 0.0;
  for (std::size_t i = 0; i < y.size(); ++i)
    sum += truths::cosine_factor(static_cast<int>(std::sqrt(static_cast<double>(i) + 0.5))) * y[i] *
           coefficients[i];
  return sum;
}

std::vector<Question> all_questions(const Questions& q, const Border& border) {
  const auto count = static_cast<std::size_t>(q.bands * q.bands);
  const int n = q.bands;
  const double rounding = 32.0 * n * n * kEpsilon;
  const double h = kPi / kHeight;
  const auto each = [](const auto& items, auto right, auto answer) {
    return [items, right, answer](const Table& table) {
      Pairs pairs;
      for (std::size_t k = 0; k < items.size(); ++k) pairs.add(right(items[k]), answer(table[k]));
      return pairs;
    };
  };
  const auto ours = [&border, n](const Values& row) { return border.to_ours(n, row); };
  const auto as_it_is = [](const Values& row) { return row; };
  return {
      {"evaluate basis", "answer-basis.csv", q.directions.size(), count,
       each(
           q.directions, [n](const Vec3d& d) { return truths::basis(n, d); },
           [&border, n](const Values& row) { return border.basis_to_ours(n, row); }),
       rounding},
      {"project lat-long", "answer-projection.csv", count, 3,
       [&border, n](const Table& table) {
         Pairs pairs;
         pairs.add(truths::projected(n, truths::polynomial_sky, n + 3), border.to_ours(n, channel(table, 1)));
         return pairs;
       },
       h * h},
      {"rotate", "answer-rotation.csv", q.rotations.size(), count,
       each(
           q.rotations, [q, n](const glm::dmat3& r) { return truths::rotated(n, q.a, r); }, ours),
       rounding},
      {"multiply", "answer-product.csv", 1, count,
       [q, &border, n](const Table& table) {
         Pairs pairs;
         pairs.add(truths::product(n, q.a, q.b), border.to_ours(n, table[0]));
         return pairs;
       },
       rounding},
      {"irradiance", "answer-irradiance.csv", q.directions.size(), 1,
       each(
           q.directions, [q](const Vec3d& d) { return Values{irradiance(q.a, d)}; }, as_it_is),
       rounding},
      {"light directional", "answer-directional.csv", q.directions.size(), count,
       each(
           q.directions, [n](const Vec3d& d) { return truths::basis(n, d); }, ours),
       rounding},
  };
}

int read_bands(const fs::path& manifest) {
  if (!fs::exists(manifest))
    throw InputError(fmt::format("{}: no such file: expected a folder of `plumbline conform --export`",
                                 manifest.string()));
  try {
    const int bands = json::parse(read_file(manifest)).at("bands").get<int>();
    if (bands < 1 || bands > 20)
      throw InputError(fmt::format("{}: bands: expected 1 to 20, got {}", manifest.string(), bands));
    return bands;
  } catch (const json::exception& error) {
    throw InputError(fmt::format("{}: {}", manifest.string(), one_line(error.what())));
  }
}

}  // namespace

void write_questions(const fs::path& folder, int bands) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!fs::is_directory(folder))
    throw InputError(fmt::format("{}: cannot make this folder", folder.string()));
  const Questions q = questions(bands);
  const auto write = [&](const char* name, const std::string& text) {
    write_text_atomically(folder / name, text);
  };
  write("directions.csv", csv(rows_of(q.directions)));
  write("rotations.csv", csv(rows_of(q.rotations)));
  write("a.csv", csv({q.a}));
  write("b.csv", csv({q.b}));
  image::LayeredImage sky;
  sky.width = kWidth;
  sky.height = kHeight;
  image::set_rgb_layer(sky, "", sky_image());
  image::write_exr(folder / "sky.exr", sky);
  write("convention.json",
        json{{"index_order", 0}, {"sign", 0}, {"norm", 0}, {"axes", {0, 0, 0}}, {"quantity", 0}}.dump(2) +
            "\n");
  write("README.txt", readme(bands));
  write("manifest.json", json{{"bands", bands}, {"version", PLUMBLINE_CONFORMANCE_VERSION}}.dump(2) + "\n");
}

Verdict judge_answers(const fs::path& folder) {
  const int bands = read_bands(folder / "manifest.json");
  plumbline_convention convention = read_convention(folder / "convention.json");
  const Questions q = questions(bands);
  const auto count = static_cast<std::size_t>(bands * bands);
  if (!Border(convention, 1).knows_basis() && bands >= 3) {
    const std::optional<Table> basis = read_answer(folder / "answer-basis.csv", q.directions.size(), count);
    Values first;
    for (const Values& row : basis.value_or(Table{})) first.insert(first.end(), row.begin(), row.begin() + 9);
    const auto found = basis ? convention_of_basis(q.directions, first) : std::nullopt;
    if (found) {
      const int32_t quantity = convention.quantity;
      convention = *found;
      convention.quantity = quantity;
    }
  }
  const Border border(convention, bands);
  Verdict verdict;
  verdict.name = "answers in " + folder.string();
  verdict.convention = to_string(convention);
  for (const Question& question : all_questions(q, border)) {
    const std::optional<Table> table = read_answer(folder / question.file, question.rows, question.columns);
    if (!table) {
      verdict.lines.push_back(missing(question));
      continue;
    }
    const bool is_known = border.knows_basis() && (convention.quantity != 0 || question.columns == 1 ||
                                                   std::string(question.operation) == "evaluate basis");
    if (is_known) {
      verdict.lines.push_back(judged_answer(question, *table, bands));
    } else {
      Line line = missing(question);
      line.judged.finding.detail = "answered, but convention.json leaves open what it needs";
      verdict.lines.push_back(std::move(line));
    }
  }
  return verdict;
}

}  // namespace plumbline::conformance

#include "services/schema/schema_model.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <set>
#include <unordered_map>
#include <utility>

#include "core/campaign_yaml/decode.h"
#include "core/campaign_yaml/decode_campaign.h"
#include "core/campaign_yaml/inline_files.h"
#include "core/input/number_text.h"

namespace dispersa {
namespace {

using Kind = Expectation::Kind;
using Keys = std::vector<std::string>;

void ReadTree(FileKind kind, InputNode root) {
  std::vector<InputProblem> ignored;
  switch (kind) {
    case FileKind::kCampaign:
      InlineCampaignFiles(root, FileNames::kRefused, ignored);
      DecodeCampaign(root, CampaignUse::kCheck, ignored, nullptr);
      return;
    case FileKind::kVehicle:
      InlineVehicleFiles(root, FileNames::kRefused, ignored);
      DecodeVehicle(root, "", ignored);
      return;
    case FileKind::kReference:
      DecodeReference(root, "", ignored);
      return;
    case FileKind::kAutopilot:
      DecodeAutopilot(root, "", 0, ignored);
      return;
    case FileKind::kScenario:
      InlineScenarioFiles(root, FileNames::kRefused, ignored);
      DecodeScenario(root, "", ignored);
      return;
  }
}

// "stages[1].name" is "stages[].name".
std::string GeneralPath(const std::string& path) {
  std::string general;
  for (std::size_t i = 0; i < path.size(); ++i) {
    general += path[i];
    if (path[i] == '[') i = path.find(']', i) - 1;
  }
  return general;
}

std::string ChildPath(const std::string& path, const std::string& key) {
  return path.empty() ? key : path + "." + key;
}

bool HasKey(const Keys& keys, const std::string& key) {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

// The wider of two limits; an absent one is none. `sign`: 1 of upper limits, -1 of lower ones.
void WidenLimit(std::string& limit, bool& open, const std::string& other, bool other_open, double sign) {
  if (limit.empty() || other.empty()) {
    limit.clear();
    open = false;
    return;
  }
  const double difference = sign * (*ParseNumber(other) - *ParseNumber(limit));
  if (difference > 0.0) limit = other;
  open = difference > 0.0 ? other_open : difference < 0.0 ? open : open && other_open;
}

// What is expected of a value in one place or another is expected in both. True if that is more than before.
bool MergeInto(std::vector<Expectation>& all, const Expectation& more) {
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Expectation& one) { return one.kind == more.kind; });
  if (found == all.end()) {
    all.push_back(more);
    return true;
  }
  Expectation& one = *found;
  const std::size_t words = one.words.size();
  WidenLimit(one.low, one.low_open, more.low, more.low_open, -1.0);
  WidenLimit(one.high, one.high_open, more.high, more.high_open, 1.0);
  for (const std::string& word : more.words)
    if (!HasKey(one.words, word)) one.words.push_back(word);
  one.open = one.open || more.open;
  one.low_count = std::min(one.low_count, more.low_count);
  one.high_count = std::max(one.high_count, more.high_count);
  if (one.unit.empty()) one.unit = more.unit;
  // The default of what has one here and another there depends on the rest; an empty text says so.
  if (more.absent && !one.absent) one.absent = more.absent;
  if (more.absent && one.absent != more.absent) one.absent = "";
  return one.words.size() > words;
}

// What the reader of one map said in one run.
struct View {
  std::map<std::string, std::string> given;  // keys and, of scalars, their text
  std::set<std::string> known;
  std::set<Keys> missing;
};

// A key that is set to try it out; without a word, to anything.
struct Setting {
  Keys keys;
  std::string word;
};

bool Holds(const Setting& setting, const View& view) {
  return std::any_of(setting.keys.begin(), setting.keys.end(), [&](const std::string& key) {
    const auto found = view.given.find(key);
    return found != view.given.end() && (setting.word.empty() || found->second == setting.word);
  });
}

bool HoldsAny(const std::vector<Setting>& settings, const View& view) {
  return std::any_of(settings.begin(), settings.end(), [&](const Setting& s) { return Holds(s, view); });
}

bool GivesAny(const View& view, const Keys& keys) {
  return std::any_of(keys.begin(), keys.end(),
                     [&](const std::string& key) { return view.given.contains(key); });
}

// Words of one key together.
std::vector<SchemaCondition> Together(const std::vector<Setting>& settings) {
  std::vector<SchemaCondition> conditions;
  for (const Setting& setting : settings) {
    const auto found = std::find_if(conditions.begin(), conditions.end(),
                                    [&](const SchemaCondition& c) { return c.keys == setting.keys; });
    if (found == conditions.end())
      conditions.push_back({setting.keys, setting.word.empty() ? Keys{} : Keys{setting.word}});
    else if (setting.word.empty())
      found->words.clear();
    else if (!found->words.empty())
      found->words.push_back(setting.word);
  }
  return conditions;
}

class Explorer : public InputObserver {
 public:
  explicit Explorer(FileKind kind) : kind_(kind) {
    place_.file = std::make_shared<const std::string>("");
    values_[""].push_back({.kind = Kind::kMap});
  }

  SchemaModel Explore() {
    SchemaModel model;
    std::map<std::string, SchemaMap> judged;  // maps that hold the same follow the same rules
    for (std::size_t before = growth_ + 1; growth_ != before;) {
      is_judging_ = false;
      Discover();
      before = growth_;
      is_judging_ = true;
      for (const std::string& path : Maps()) {
        const auto [entry, is_new] = judged.try_emplace(Likeness(path));
        if (is_new) entry->second = Judge(path);
        model.maps[path] = entry->second;
      }
    }
    model.values = {values_.begin(), values_.end()};
    return model;
  }

  void Reads(const std::string& path, const InputNode& node) override {
    Expects(path, {.kind = Kind::kMap});
    if (GeneralPath(path) != focus_) return;
    View& view = run_[path];
    for (const InputMember& member : node.members) view.given.emplace(member.key, member.value.text);
  }

  void Knows(const std::string& path, const Keys& keys) override {
    const std::string general = GeneralPath(path);
    if (general == focus_) run_[path].known.insert(keys.begin(), keys.end());
    Learn(fields_[general], keys);
  }

  void Heeds(const std::string& path, const Keys& keys) override { Learn(heeded_[GeneralPath(path)], keys); }

  void Misses(const std::string& path, const Keys& keys) override {
    const std::string general = GeneralPath(path);
    if (general != focus_) return;
    // Whatever the unit that the reader names.
    Keys spellings;
    for (const std::string& key : keys)
      for (const std::string& spelling : Spellings(general, key))
        if (!HasKey(spellings, spelling)) spellings.push_back(spelling);
    run_[path].missing.insert(spellings);
  }

  void Expects(const std::string& path, const Expectation& expectation) override {
    growth_ += MergeInto(values_[GeneralPath(path)], expectation);
  }

 private:
  static constexpr int kTrials = 20;
  static constexpr int kShapes = 4;

  Keys Spellings(const std::string& path, const std::string& key) const {
    if (const auto found = fields_.find(path); found != fields_.end())
      for (const Keys& keys : found->second)
        if (HasKey(keys, key)) return keys;
    return {key};
  }

  // A thing's spellings are those of the longest list that names one of them.
  void Learn(std::vector<Keys>& fields, const Keys& keys) {
    for (Keys& field : fields) {
      if (!HasKey(field, keys.front())) continue;
      if (keys.size() <= field.size()) return;
      field = keys;
      ++growth_;
      return;
    }
    fields.push_back(keys);
    ++growth_;
  }

  // ---- Trees ----

  double Random() { return static_cast<double>(random_()) / 4294967296.0; }
  std::size_t Random(std::size_t count) { return random_() % count; }

  const Expectation* Expected(const std::string& path, Kind kind) const {
    const auto found = values_.find(path);
    if (found == values_.end()) return nullptr;
    for (const Expectation& expectation : found->second)
      if (expectation.kind == kind) return &expectation;
    return nullptr;
  }

  bool IsDocument(const std::string& path) const {
    return !path.empty() && Expected(path, Kind::kDocument) != nullptr;
  }

  // Maps of this kind of file, not of a document in it.
  std::vector<std::string> Maps() const {
    std::vector<std::string> maps, paths;
    for (const auto& [path, expectations] : values_) paths.push_back(path);
    std::sort(paths.begin(), paths.end());
    std::string document = "\n";
    for (const std::string& path : paths) {
      if (path.starts_with(document)) continue;
      if (IsDocument(path)) {
        document = path;
        continue;
      }
      if (Expected(path, Kind::kMap) != nullptr && Expected(path, Kind::kColumns) == nullptr)
        maps.push_back(path);
    }
    return maps;
  }

  // All that a map is known to have, and what may turn out to be.
  std::vector<Keys> Candidates(const std::string& path) const {
    std::vector<Keys> candidates;
    if (const auto found = fields_.find(path); found != fields_.end()) candidates = found->second;
    if (const auto found = heeded_.find(path); found != heeded_.end())
      for (const Keys& keys : found->second)
        if (std::none_of(candidates.begin(), candidates.end(),
                         [&](const Keys& c) { return HasKey(c, keys.front()); }))
          candidates.push_back(keys);
    return candidates;
  }

  bool LeadsToFocus(const std::string& path) const {
    if (path == focus_ || path.empty()) return true;
    return focus_.starts_with(path) && (focus_[path.size()] == '.' || focus_[path.size()] == '[');
  }

  InputNode Scalar(std::string text) const { return ScalarAt(place_, std::move(text)); }

  // Somewhere in the range.
  static std::string SampleNumber(const Expectation& number) {
    const auto low = ParseNumber(number.low), high = ParseNumber(number.high);
    if (number.kind == Kind::kInteger && low) return number.low;
    if (low && high) return FormatNumber(0.5 * (*low + *high));
    return FormatNumber(low ? *low + 1.0 : high ? *high - 1.0 : 0.5);
  }

  InputNode List(const std::string& path) {
    const Expectation* list = Expected(path, Kind::kList);
    std::size_t count = list == nullptr ? 1 : std::max<std::size_t>(list->low_count, 1);
    if (Random() < 0.3 && (list == nullptr || count < list->high_count)) ++count;
    InputNode node = ListAt(place_);
    for (std::size_t i = 0; i < count; ++i) node.items.push_back(Value(path + "[]"));
    return node;
  }

  InputNode Map(const std::string& path) {
    InputNode node = MapAt(place_);
    const bool is_focus = path == focus_;
    const bool is_within = !is_bare_ && path.starts_with(focus_);
    const double share = is_focus ? 0.4 : is_within && !focus_.empty() ? std::max(share_, 0.3) : share_;
    for (const Keys& keys : Candidates(path)) {
      const Setting* forced = nullptr;
      for (const Setting& setting : settings_)
        if (is_focus && setting.keys == keys) forced = &setting;
      const bool leads = !is_focus && LeadsToFocus(path) && LeadsToFocus(ChildPath(path, keys.front()));
      const bool is_in = leads || forced != nullptr || (!(is_focus && is_bare_) && Random() < share);
      if (!is_in || (path.empty() && keys.front() == "schema")) continue;
      const std::string& key = keys[Random(keys.size())];
      SetMember(
          node, key,
          forced != nullptr && !forced->word.empty() ? Scalar(forced->word) : Value(ChildPath(path, key)));
    }
    return node;
  }

  // Of any shape, to see what the reader says to it.
  InputNode Probe(const std::string& path) {
    switch (IsProbed(path) ? shape_ : 1 + static_cast<int>(Random(kShapes))) {
      case 1:
        return Map(path);
      case 2:
        return Scalar("word");
      case 3:
        return Scalar("1");
      default:
        return List(path);
    }
  }

  // The focus' own values take the shape that is tried.
  bool IsProbed(const std::string& path) const {
    return shape_ > 0 && std::any_of(settings_.begin(), settings_.end(), [&](const Setting& setting) {
             return std::any_of(setting.keys.begin(), setting.keys.end(),
                                [&](const std::string& key) { return ChildPath(focus_, key) == path; });
           });
  }

  InputNode Value(const std::string& path) {
    if (++depth_ > 60) return Scalar("1");
    struct Rise {
      int& depth;
      ~Rise() { --depth; }
    } rise{depth_};
    if (IsDocument(path)) return {};  // as if it had not been readable: another schema's
    if (LeadsToFocus(path)) return focus_.starts_with(path + "[]") ? List(path) : Map(path);
    const auto found = values_.find(path);
    std::vector<const Expectation*> shapes;
    if (found != values_.end())
      for (const Expectation& expectation : found->second) shapes.push_back(&expectation);
    static const Expectation list{.kind = Kind::kList};
    if (Expected(path, Kind::kList) == nullptr && values_.contains(path + "[]")) shapes.push_back(&list);
    if (shapes.empty() || IsProbed(path) || (!is_bare_ && !is_judging_ && Random() < 0.08))
      return Probe(path);
    const Expectation& shape = *shapes[Random(shapes.size())];
    switch (shape.kind) {
      case Kind::kNumber:
      case Kind::kInteger:
        return Scalar(SampleNumber(shape));
      case Kind::kFlag:
        return Scalar(Random() < 0.5 ? "true" : "false");
      case Kind::kWords:
        return Scalar(shape.words.empty() ? "word" : shape.words[Random(shape.words.size())]);
      case Kind::kList:
        return List(path);
      case Kind::kMap:
      case Kind::kColumns:
      case Kind::kNumbers:
        return Map(path);
      case Kind::kText:
      case Kind::kFile:
      case Kind::kDocument:
        break;
    }
    return Scalar("word");
  }

  // Until nothing more is learned of any map.
  void Discover() {
    std::set<std::string> quiet;
    for (bool is_news = true; is_news;) {
      is_news = false;
      for (const std::string& path : Maps()) {
        if (quiet.contains(path)) continue;
        const std::size_t knew = growth_;
        for (const Setting& setting : Settings(path)) RunWith(path, {setting});
        for (const Keys& keys : Candidates(path))
          if (probed_.insert(ChildPath(path, keys.front())).second)
            for (shape_ = 1; shape_ <= kShapes; ++shape_) RunWith(path, {{keys, ""}});
        shape_ = 0;
        for (int i = 0; i < kTrials; ++i) RunAnyhow(path);
        if (growth_ == knew) quiet.insert(path);
        is_news = true;
      }
    }
  }

  // ---- Runs ----

  void Run() {
    run_.clear();
    depth_ = 0;
    InputNode root = Map("");
    SetMember(root, "schema", Scalar(SchemaOf(kind_)));
    Listening listening(*this);
    ReadTree(kind_, std::move(root));
  }

  // The map at `path` with nothing but the settings.
  void RunWith(const std::string& path, std::vector<Setting> settings, double share = 0.0) {
    focus_ = path;
    settings_ = std::move(settings);
    is_bare_ = true;
    share_ = share;
    Run();
  }

  void RunAnyhow(const std::string& path) {
    focus_ = path;
    settings_.clear();
    is_bare_ = false;
    const double shares[] = {0.01, 0.05, 0.3};
    share_ = shares[Random(3)];
    Run();
  }

  std::vector<Setting> Settings(const std::string& path) const {
    std::vector<Setting> settings;
    for (const Keys& keys : Candidates(path)) {
      const std::string child = ChildPath(path, keys.front());
      const Expectation* words = Expected(child, Kind::kWords);
      if (words != nullptr && !words->open)
        for (const std::string& word : words->words) settings.push_back({keys, word});
      else if (Expected(child, Kind::kFlag) != nullptr)
        for (const char* word : {"true", "false"}) settings.push_back({keys, word});
      else
        settings.push_back({keys, ""});
    }
    return settings;
  }

  // ---- Rules ----

  // What the reader of the map said in some runs, if all of them reached it: in any run, and in every one.
  struct Trial {
    bool reached = true;
    std::set<std::string> known_sometimes, known_always;
    std::set<Keys> missing_sometimes, missing_always;
  };

  Trial Try(const std::string& path, const std::vector<Setting>& settings) {
    Trial trial;
    bool is_first = true;
    for (int i = 0; i < 3; ++i) {
      RunWith(path, settings);
      // Some maps are read only beside others.
      for (int more = 0; run_.empty() && more < 300; ++more) RunWith(path, settings, 0.4);
      bool reached = false;
      for (const auto& [at, view] : run_) {
        reached = true;
        if (std::exchange(is_first, false)) {
          trial.known_always = view.known;
          trial.missing_always = view.missing;
        }
        trial.known_sometimes.insert(view.known.begin(), view.known.end());
        trial.missing_sometimes.insert(view.missing.begin(), view.missing.end());
        std::erase_if(trial.known_always, [&](const std::string& key) { return !view.known.contains(key); });
        std::erase_if(trial.missing_always, [&](const Keys& keys) { return !view.missing.contains(keys); });
      }
      trial.reached = trial.reached && reached;
    }
    return trial;
  }

  // Equal for maps that hold the same and demand the same.
  std::string Likeness(const std::string& path) {
    std::set<std::string> holds;
    for (const Keys& keys : Candidates(path)) {
      holds.insert("\nmay " + keys.front());
      const auto found = values_.find(ChildPath(path, keys.front()));
      if (found == values_.end()) continue;
      for (const Expectation& one : found->second)
        for (const std::string& word : one.words) holds.insert("\n" + keys.front() + " " + word);
    }
    std::string likeness;
    for (const std::string& what : holds) likeness += what;
    const Trial bare = Try(path, {});
    for (const Keys& keys : bare.missing_always) likeness += "\nmisses " + keys.front();
    for (const std::string& key : bare.known_always) likeness += "\nknows " + key;
    return likeness;
  }

  bool Demands(const std::string& path, const std::vector<Setting>& settings, const Keys& keys) {
    RunWith(path, settings);
    return !run_.empty() && std::all_of(run_.begin(), run_.end(),
                                        [&](const auto& one) { return one.second.missing.contains(keys); });
  }

  SchemaMap Judge(const std::string& path) {
    const Trial bare = Try(path, {});
    const std::vector<Setting> settings = Settings(path);
    std::vector<Trial> trials;
    for (const Setting& setting : settings) trials.push_back(Try(path, {setting}));
    // Anything else, which a rule must not contradict.
    std::vector<View> evidence;
    for (int i = 0; i < 3 * kTrials; ++i) {
      RunAnyhow(path);
      for (const auto& [at, view] : run_) evidence.push_back(view);
    }

    SchemaMap map;
    std::set<Keys> demanded = bare.missing_sometimes;
    for (const Trial& trial : trials)
      demanded.insert(trial.missing_sometimes.begin(), trial.missing_sometimes.end());
    for (const Keys& keys : demanded) {
      std::vector<Setting> unless, only_if;
      for (std::size_t i = 0; i < settings.size(); ++i) {
        if (HasKey(keys, settings[i].keys.front())) continue;
        if (!trials[i].reached || !trials[i].missing_always.contains(keys)) unless.push_back(settings[i]);
        if (trials[i].reached && trials[i].missing_always.contains(keys)) only_if.push_back(settings[i]);
      }
      const auto contradicted = [&](const auto& applies) {
        return std::any_of(evidence.begin(), evidence.end(), [&](const View& view) {
          return applies(view) && !GivesAny(view, keys) && !view.missing.contains(keys);
        });
      };
      if (bare.missing_always.contains(keys)) {
        if (!contradicted([&](const View& view) { return !HoldsAny(unless, view); }))
          map.requirements.push_back({keys, Together(unless), {}});
        continue;
      }
      // Beside another key the demand may fall.
      for (const Setting& setting : only_if) {
        std::vector<Setting> but;
        for (const Setting& other : settings)
          if (other.keys != setting.keys && !HasKey(keys, other.keys.front()) &&
              !Demands(path, {setting, other}, keys))
            but.push_back(other);
        if (contradicted([&](const View& view) { return Holds(setting, view) && !HoldsAny(but, view); }))
          continue;
        map.requirements.push_back({keys, Together(but), Together({setting})});
      }
    }

    for (const Keys& keys : Fields(path)) {
      SchemaField field{keys, {}, {}};
      const std::string& key = keys.front();
      const auto known_though = [&](const auto& applies) {
        return std::any_of(evidence.begin(), evidence.end(),
                           [&](const View& view) { return applies(view) && view.known.contains(key); });
      };
      std::vector<Setting> allow, forbid;
      for (std::size_t i = 0; i < settings.size(); ++i) {
        if (trials[i].known_sometimes.contains(key)) allow.push_back(settings[i]);
        if (trials[i].reached && !trials[i].known_sometimes.contains(key)) forbid.push_back(settings[i]);
      }
      if (bare.known_always.contains(key)) {
        std::erase_if(forbid, [&](const Setting& setting) {
          return setting.keys == keys || known_though([&](const View& view) { return Holds(setting, view); });
        });
        field.not_if = Together(forbid);
      } else if (!allow.empty() &&
                 std::none_of(allow.begin(), allow.end(),
                              [&](const Setting& setting) { return setting.keys == keys; }) &&
                 !known_though([&](const View& view) { return !HoldsAny(allow, view); })) {
        field.only_if = Together(allow);
      }
      map.fields.push_back(std::move(field));
    }
    return map;
  }

  std::vector<Keys> Fields(const std::string& path) const {
    const auto found = fields_.find(path);
    return found == fields_.end() ? std::vector<Keys>{} : found->second;
  }

  const FileKind kind_;
  InputNode place_;
  std::mt19937 random_{1};
  std::unordered_map<std::string, std::vector<Expectation>> values_;
  std::unordered_map<std::string, std::vector<Keys>> fields_, heeded_;
  std::size_t growth_ = 0;

  std::string focus_;  ///< the map that the run is about
  std::vector<Setting> settings_;
  bool is_bare_ = false;
  bool is_judging_ = false;       ///< by what is expected only
  double share_ = 0.0;            ///< of what may be in other maps, what is
  std::set<std::string> probed_;  ///< values that were given every shape
  int shape_ = 0;                 ///< of what is strange, 1 to kShapes; 0: at random
  int depth_ = 0;
  std::map<std::string, View> run_;
};

}  // namespace

SchemaModel LearnSchema(FileKind kind) { return Explorer(kind).Explore(); }

}  // namespace dispersa

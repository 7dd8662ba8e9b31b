#include "services/web/campaign_row.h"

#include <algorithm>
#include <cctype>
#include <sstream>

#include "services/web/find_by_id.h"

namespace dispersa {
namespace {

std::string LowerCase(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string SearchedText(const CampaignRow& row) {
  std::string text = row.id + "\n" + row.name + "\n" + row.owner + "\n" + row.state + "\n" + row.verdict;
  for (const std::string& label : row.labels) text += "\n" + label;
  return LowerCase(std::move(text));
}

}  // namespace

CampaignIndex::CampaignIndex(std::vector<Row> rows, std::vector<WorkerRow> workers)
    : rows_(std::move(rows)), workers_(std::move(workers)) {
  std::sort(rows_.begin(), rows_.end(), [](const Row& a, const Row& b) { return a->order > b->order; });
  for (const Row& row : rows_) by_id_[row->id] = row.get();
}

const CampaignRow* CampaignIndex::Find(const std::string& prefix) const {
  const auto found = FindById(by_id_, prefix);
  return found == by_id_.end() ? nullptr : found->second;
}

std::vector<const CampaignRow*> CampaignIndex::Search(const std::string& text) const {
  std::vector<std::string> words;
  std::istringstream stream(LowerCase(text));
  for (std::string word; stream >> word;) words.push_back(word);
  std::vector<const CampaignRow*> found;
  for (const Row& row : rows_) {
    const std::string searched = words.empty() ? "" : SearchedText(*row);
    if (std::all_of(words.begin(), words.end(),
                    [&](const std::string& word) { return searched.find(word) != std::string::npos; }))
      found.push_back(row.get());
  }
  return found;
}

}  // namespace dispersa

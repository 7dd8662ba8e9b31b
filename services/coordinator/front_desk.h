// Requests of clients and the coordinator's replies. idl/README.md lists the requests.
#pragma once

#include <cstdint>
#include <filesystem>
#include <future>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "services/coordinator/database_copies.h"
#include "services/coordinator/service.h"
#include "services/transport/permissions.h"

namespace dispersa {

/// Who asks: a campaign that it launches belongs to `account`.
struct Asker {
  std::string account;  ///< the name of its keys, or the local user
  std::string client;   ///< its process
  Right right = Right::kRun;
};

/// Where the coordinator serves its pages.
struct WebPages {
  std::string address;      ///< "127.0.0.1:8080"; empty: nowhere
  bool behind_tls = false;  ///< readers know a proxy's address instead
};

/// A request may come several times, since clients repeat it until the reply arrives: none does more the
/// second time than the first.
class FrontDesk {
 public:
  /// Without keys everybody who is heard is `everybody`, and may do all. With keys it is empty.
  /// `own_keys`: the name of the coordinator's keys, which may drain it.
  FrontDesk(Service& service, const Workforce& workforce, std::string everybody, WebPages pages = {},
            std::string own_keys = "");

  Reply Answer(const Request& request);

 private:
  /// A campaign's text that comes in parts.
  struct Upload {
    std::string text;
    std::uint64_t size = 0;
    double used_s = 0.0;
    std::string owner;  ///< the name of its client's keys, or of a client without
    std::future<CatalogueEntry> parsed;
  };

  /// A campaign as a backup takes it.
  struct CampaignSnapshot {
    std::string name;        ///< of the backup
    std::string state_json;  ///< of the moment before the database is copied
    std::vector<std::filesystem::path> files;
  };

  struct Call {
    Asker asker;
    nlohmann::ordered_json arguments;
    const std::string& data;
    std::string& answered;  ///< data, beside the text
  };
  /// What may be asked for, and what answers.
  struct Method {
    struct How {
      bool is_noted = false;        ///< in the log of actions
      bool begins_flights = false;  ///< not while the coordinator is drained
      bool is_for_itself = false;   ///< the coordinator's own keys may, whatever their right
      bool is_for_backups = false;  ///< of all campaigns, or a snapshot: for those who may administer
    };
    std::string_view name;
    Right right;  ///< the least, whatever campaign it is about
    const char* command;
    How how;
    std::string (FrontDesk::*answer)(const Call&);
  };
  static const Method& MethodOf(const std::string& name);

  Asker AskerOf(const std::string& client) const;
  std::string Live(const Call& call);
  std::string TakePart(const Call& call);
  std::string Launch(const Call& call);
  std::string LaunchAgain(const Asker& asker, const CatalogueEntry& entry, std::optional<int> priority,
                          const std::vector<std::string>& labels);
  std::string Cancel(const Call& call);
  std::string Give(const Call& call);
  std::string Repair(const Call& call);
  std::string Drain(const Call& call);
  std::string Readmit(const Call& call);
  std::string Expelled(const Call& call);
  std::string Delete(const Call& call);
  std::string Ids(const Call& call);
  std::string List(const Call& call);
  std::string Status(const Call& call);
  std::string Files(const Call& call);
  std::string Read(const Call& call);
  std::vector<std::string> Listed(std::size_t most) const;
  std::string Journals() const;
  std::string Snapshot(const CatalogueEntry& entry, const std::string& name);
  std::filesystem::path FindInSnapshot(const CatalogueEntry& entry, const std::string& name,
                                       const std::filesystem::path& path);
  std::filesystem::path FindInResults(const CatalogueEntry& entry, const std::filesystem::path& path);
  /// Into the log of actions, when it is done.
  void Note(const char* what, const Asker& asker, const CatalogueEntry& entry, Action more = {});
  const CatalogueEntry& Named(const std::string& id) const;
  void ForgetUploads();

  Service& service_;
  const Workforce& workforce_;
  std::string everybody_;
  WebPages pages_;
  std::string own_keys_;
  std::map<std::string, Upload> uploads_;  ///< by id
  DatabaseCopies copies_;
  std::map<std::string, CampaignSnapshot> snapshots_;  ///< by id: of the last backup
  std::set<std::string> readmitted_;                   ///< names, for the same reason
  std::set<std::string> deleted_;                      ///< ids: a client whose answer got lost asks again
};

}  // namespace dispersa

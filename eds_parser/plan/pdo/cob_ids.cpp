#include "eds_parser/plan/pdo/cob_ids.hpp"

#include <algorithm>

namespace takt {
namespace {

constexpr std::uint32_t first_free = 0x181;
constexpr std::uint32_t last_free = 0x57F;

/// A PDO that claims a COB-ID.
struct User {
  EffectivePdo* pdo = nullptr;
  const NodeSource* node = nullptr;

  std::uint32_t predefined() const {
    return (pdo->is_tpdo ? 0x180U : 0x200U) + 0x100U * (pdo->number - 1U) + node->id.value();
  }
  bool has_predefined() const {
    return pdo->number <= 4 && pdo->cob_id == CobId::base(predefined());
  }
  bool has(CobIdOrigin origin) const { return pdo->has_cob_id && pdo->origin == origin; }
  const std::string& file() const { return node->dictionary->file; }
};

std::string to_string(const User& user) { return user.pdo->label(*user.node->spec); }

class CobIdAssigner {
 public:
  CobIdAssigner(std::span<NodePdos> nodes, const std::map<CobId, std::string>& services,
                NetworkReport& report)
      : nodes_{nodes}, services_{services}, report_{report} {}

  void run() {
    each([&](User user) {
      if (user.has(CobIdOrigin::network_file)) claim_of_file(user);
    });
    each([&](User user) {
      if (user.has(CobIdOrigin::device_file) && user.has_predefined()) claim_of_device(user);
    });
    each([&](User user) {
      const EffectivePdo& pdo = *user.pdo;
      if (!pdo.has_cob_id && pdo.is_tpdo && pdo.number <= 4) claim_predefined(user);
    });
    // TPDOs come first, so that an RPDO finds its sender.
    for (const bool is_tpdo : {true, false}) {
      each([&](User user) {
        const bool open = user.has(CobIdOrigin::device_file) && !user.has_predefined();
        if (open && user.pdo->is_tpdo == is_tpdo) claim_of_device(user);
      });
    }
    each([&](User user) {
      if (!user.pdo->has_cob_id && user.pdo->number <= 4) claim_automatic(user);
    });
    each([&](User user) {
      if (!user.pdo->has_cob_id) claim_automatic(user);
    });
  }

 private:
  template <class F>
  void each(F&& f) {
    for (NodePdos& node : nodes_) {
      for (EffectivePdo& pdo : node.pdos) {
        if (pdo.use == PdoUse::exchanged) f(User{&pdo, &node.node});
      }
    }
  }

  /// Returns why no PDO may have this COB-ID. The result is empty if a PDO may have it.
  std::string service_at(CobId id) const {
    const auto service = services_.find(id);
    if (service != services_.end()) return service->second;
    const bool reserved = !id.is_extended() && is_restricted(id.id());
    return reserved ? "is reserved by CiA 301 (table 40)" : "";
  }

  void take(User user, CobId id) {
    user.pdo->cob_id = id;
    user.pdo->has_cob_id = true;
    used_[id] = user;
  }

  void claim_of_file(User user) {
    const EffectivePdo& pdo = *user.pdo;
    const auto refuse = [&](std::string_view rule, const auto&... why) {
      report_.error(pdo.cob_id_pos, rule, "`cob_id` ", pdo.cob_id, " of ", user, " ", why...,
                    "; `auto` would give ", hex(automatic(user), 3));
    };
    if (const std::string service = service_at(pdo.cob_id); !service.empty()) {
      return refuse("cob-id", service);
    }
    const auto other = used_.find(pdo.cob_id);
    if (other == used_.end()) return take(user, pdo.cob_id);
    if (other->second.pdo->is_tpdo != pdo.is_tpdo) return link(user, other->second);
    refuse("cob-id-clash", "belongs to ", other->second, " (line ",
           other->second.pdo->cob_id_pos.line, ") already");
  }

  /// Links a TPDO and an RPDO with the same COB-ID. The devices then communicate directly, and the
  /// master only listens.
  void link(User user, User other) {
    const CobId id = user.pdo->cob_id;
    const auto& [sender, receiver] =
        user.pdo->is_tpdo ? std::pair{user, other} : std::pair{other, user};
    receiver.pdo->use = PdoUse::linked;
    used_[id] = sender;
    const bool stated = receiver.pdo->origin == CobIdOrigin::device_file;
    report_.note(
        user.pdo->cob_id_pos, "linked", receiver, " receives ", sender, " (both ", id,
        stated ? ", which " + receiver.file() + " sets" : "",
        "); the master does not send this RPDO",
        stated ? ". Write `cob_id: auto` for it under `rpdo:` if the master should send it" : "");
  }

  void claim_of_device(User user) {
    const CobId id = user.pdo->cob_id;
    const std::string service = service_at(id);
    const auto other = used_.find(id);
    if (!service.empty()) return move(user, nullptr, service);
    if (other == used_.end()) return take(user, id);
    if (is_link(user, other->second)) return link(user, other->second);
    move(user, &other->second, service);
  }

  /// Returns true if `user` and `other`, which have the same COB-ID, form a link: a device file
  /// states one of the two COB-IDs, and the network file or another device file states the other.
  /// There is no link if the master is to send the RPDO (the network file mentions it without a
  /// COB-ID), or if both COB-IDs are only the predefined ones of their nodes.
  static bool is_link(const User& user, const User& other) {
    const EffectivePdo& pdo = *user.pdo;
    if (pdo.is_tpdo == other.pdo->is_tpdo || other.node == user.node) return false;
    if (other.pdo->origin == CobIdOrigin::network_file) return pdo.is_tpdo || !pdo.named;
    return !pdo.is_tpdo && !pdo.named && !user.has_predefined();
  }

  /// Gives a PDO another COB-ID. `other` is the PDO that already has the current one; if it is
  /// nullptr, `service` is the reason why no PDO may have it.
  void move(User user, const User* other, const std::string& service) {
    EffectivePdo& pdo = *user.pdo;
    const CobId was = pdo.cob_id;
    const std::uint32_t free = automatic(user);
    if (free == 0) return none_free(user);
    const CobId id = CobId::base(free);
    // The network file gives one PDO the COB-ID with which another PDO is sent according to its
    // device file.
    const bool is_clash =
        pdo.is_tpdo && other != nullptr && other->pdo->origin == CobIdOrigin::network_file;
    if (is_clash) {
      report_.error(other->pdo->cob_id_pos, "cob-id-clash", "`cob_id` ", was, " of ", *other,
                    " is also used by ", user, " in ", user.file(),
                    ": write `cob_id: auto` for one of them (", user, " would get ", hex(free, 3),
                    ")");
      pdo.origin = CobIdOrigin::automatic;
      return take(user, id);
    }
    const std::string text =
        concat(user, " has COB-ID ", was, " in ", user.file(), ", which ",
               other == nullptr ? service : "is used by " + to_string(*other), "; takt uses ", id);
    const bool cut =
        other != nullptr && other->node != user.node && other->pdo->is_tpdo != pdo.is_tpdo;
    if (cut) {
      report_.warning(pdo.cob_id_pos, "cob-id-moved", text,
                      ". If the two devices should exchange data with this id, write `cob_id: ",
                      was, "` for both PDOs; if not, `cob_id: auto` for this one");
    } else {
      report_.note(pdo.cob_id_pos, "cob-id-moved", text);
    }
    pdo.origin = CobIdOrigin::automatic;
    take(user, id);
  }

  void none_free(const User& user) {
    report_.error(user.pdo->cob_id_pos, "cob-id", "no COB-ID is free for ", user,
                  " in 0x181..0x57F");
  }

  /// Gives a TPDO its predefined COB-ID. If the network file gives this COB-ID to an RPDO of
  /// another device, the two PDOs form a link. Otherwise, a PDO that already has this COB-ID keeps
  /// it.
  void claim_predefined(User user) {
    const CobId id = CobId::base(user.predefined());
    if (!service_at(id).empty()) return;
    const auto other = used_.find(id);
    if (other == used_.end()) return take(user, id);
    if (!is_link(user, other->second)) return;
    user.pdo->cob_id = id;
    user.pdo->has_cob_id = true;
    link(user, other->second);
  }

  void claim_automatic(User user) {
    const std::uint32_t id = automatic(user);
    if (id == 0) return none_free(user);
    if (user.pdo->number <= 4 && id != user.predefined()) report_taken(user, id);
    take(user, CobId::base(id));
  }

  /// Reports that a PDO can't have its predefined COB-ID. This is an error if the network file
  /// gives it to two TPDOs: to one by its number, to the other one by `auto`.
  void report_taken(const User& user, std::uint32_t free) {
    const CobId own = CobId::base(user.predefined());
    const auto other = used_.find(own);
    const bool is_twice = other != used_.end() && user.pdo->is_tpdo && other->second.pdo->is_tpdo &&
                          other->second.pdo->origin == CobIdOrigin::network_file;
    if (is_twice) {
      const User& owner = other->second;
      report_.error(owner.pdo->cob_id_pos, "cob-id-clash", "`cob_id` ", own, " of ", owner,
                    " is the predefined COB-ID of ", user,
                    ", which has no fixed `cob_id`: write `cob_id: ", hex(free, 3), "` for ", user,
                    ", or another `cob_id` for ", owner);
      return;
    }
    report_.note(user.pdo->cob_id_pos, "cob-id-moved", "the predefined COB-ID ", own, " of ", user,
                 " ",
                 other == used_.end() ? service_at(own) : "is used by " + to_string(other->second),
                 "; takt uses ", hex(free, 3));
  }

  /// Returns the predefined COB-ID if it is free, else the lowest free identifier. Identifiers
  /// outside the predefined connection set are preferred.
  std::uint32_t automatic(const User& user) const {
    const auto is_free = [&](std::uint32_t id) {
      return !used_.contains(CobId::base(id)) && service_at(CobId::base(id)).empty();
    };
    if (user.pdo->number <= 4 && is_free(user.predefined())) return user.predefined();
    for (const bool spare_predefined : {true, false}) {
      for (std::uint32_t id = first_free; id <= last_free; ++id) {
        if (!(spare_predefined && is_predefined(id)) && is_free(id)) return id;
      }
    }
    return 0;
  }

  bool is_predefined(std::uint32_t id) const {
    return std::ranges::any_of(
        nodes_, [&](const NodePdos& node) { return (id & 0x7F) == node.node.id.value(); });
  }

  std::span<NodePdos> nodes_;
  const std::map<CobId, std::string>& services_;
  NetworkReport& report_;
  std::map<CobId, User> used_;
};

}  // namespace

bool is_restricted(std::uint32_t id) noexcept {
  const auto in = [id](std::uint32_t low, std::uint32_t high) { return id >= low && id <= high; };
  return in(0x000, 0x07F) || in(0x101, 0x180) || in(0x581, 0x5FF) || in(0x601, 0x67F) ||
         in(0x6E0, 0x6FF) || in(0x701, 0x77F) || in(0x780, 0x7FF);
}

void assign_cob_ids(std::span<NodePdos> nodes, const std::map<CobId, std::string>& services,
                    NetworkReport& report) {
  CobIdAssigner{nodes, services, report}.run();
}

}  // namespace takt

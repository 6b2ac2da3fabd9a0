#include "eds_parser/plan/pdo/cob_ids.hpp"

#include <algorithm>
#include <map>

namespace takt {
namespace {

constexpr std::uint32_t first_free = 0x181;
constexpr std::uint32_t last_free = 0x57F;

std::uint32_t predefined(const EffectivePdo& pdo, NodeId node) {
  const std::uint32_t base = pdo.is_tpdo ? 0x180U : 0x200U;
  return base + 0x100U * (pdo.number - 1U) + node.value();
}

struct User {
  EffectivePdo* pdo = nullptr;
  const NodeSource* node = nullptr;
  std::string text() const { return pdo->label() + " of node `" + node->spec->name + "`"; }
};

class CobIdAssigner {
 public:
  CobIdAssigner(std::span<NodePdos> nodes, const std::map<CobId, std::string>& services,
                NetworkReport& report)
      : nodes_{nodes}, services_{services}, report_{report} {}

  void run() {
    each([&](NodePdos& n, EffectivePdo& p) {
      if (p.has_cob_id && p.origin == CobIdOrigin::network_file) claim_of_file(n, p);
    });
    const auto device = [](const EffectivePdo& p) {
      return p.has_cob_id && p.origin == CobIdOrigin::device_file;
    };
    each([&](NodePdos& n, EffectivePdo& p) {
      if (device(p) && is_own(n, p)) claim_of_device(n, p);
    });
    each([&](NodePdos& n, EffectivePdo& p) {
      if (!p.has_cob_id && p.is_tpdo && p.number <= 4) claim_predefined(n, p);
    });
    // TPDOs come first, so that an RPDO finds its sender.
    for (const bool is_tpdo : {true, false}) {
      each([&](NodePdos& n, EffectivePdo& p) {
        if (device(p) && !is_own(n, p) && p.is_tpdo == is_tpdo) claim_of_device(n, p);
      });
    }
    each([&](NodePdos& n, EffectivePdo& p) {
      if (!p.has_cob_id && p.number <= 4) claim_automatic(n, p);
    });
    each([&](NodePdos& n, EffectivePdo& p) {
      if (!p.has_cob_id) claim_automatic(n, p);
    });
  }

 private:
  template <class F>
  void each(F&& f) {
    for (NodePdos& node : nodes_) {
      for (EffectivePdo& pdo : node.pdos) {
        if (pdo.use == PdoUse::exchanged) f(node, pdo);
      }
    }
  }

  static bool is_own(const NodePdos& node, const EffectivePdo& pdo) {
    return pdo.number <= 4 && pdo.cob_id == CobId::base(predefined(pdo, node.node.id));
  }

  /// Returns why no PDO may have this COB-ID. The result is empty if a PDO may have it.
  std::string service_at(CobId id) const {
    const auto service = services_.find(id);
    if (service != services_.end()) return service->second;
    const bool reserved = !id.is_extended() && is_restricted(id.id());
    return reserved ? "is reserved by CiA 301 (table 40)" : "";
  }

  void take(NodePdos& node, EffectivePdo& pdo, CobId id) {
    pdo.cob_id = id;
    pdo.has_cob_id = true;
    used_[id] = {&pdo, &node.node};
  }

  void claim_of_file(NodePdos& node, EffectivePdo& pdo) {
    const User user{&pdo, &node.node};
    if (const std::string service = service_at(pdo.cob_id); !service.empty()) {
      report_.error(pdo.cob_id_pos, "cob-id",
                    "`cob_id` " + to_string(pdo.cob_id) + " of " + user.text() + " " + service +
                        "; `auto` would give " + hex(automatic(node, pdo), 3));
      return;
    }
    const auto other = used_.find(pdo.cob_id);
    if (other == used_.end()) {
      take(node, pdo, pdo.cob_id);
    } else if (other->second.pdo->is_tpdo != pdo.is_tpdo) {
      link(pdo, other->second, user);
    } else {
      report_.error(pdo.cob_id_pos, "cob-id-clash",
                    "`cob_id` " + to_string(pdo.cob_id) + " of " + user.text() + " belongs to " +
                        other->second.text() + " (line " +
                        std::to_string(other->second.pdo->cob_id_pos.line) + ") already; `auto` " +
                        "would give " + hex(automatic(node, pdo), 3));
    }
  }

  /// Links a TPDO and an RPDO with the same COB-ID. The devices then communicate directly, and the
  /// master only listens.
  void link(EffectivePdo& pdo, User other, User user) {
    EffectivePdo& receiver = pdo.is_tpdo ? *other.pdo : pdo;
    const User& sender = pdo.is_tpdo ? user : other;
    const User& fed = pdo.is_tpdo ? other : user;
    receiver.use = PdoUse::linked;
    used_[pdo.cob_id] = sender;
    const bool stated = receiver.origin == CobIdOrigin::device_file;
    report_.note(
        pdo.cob_id_pos, "linked",
        fed.text() + " receives " + sender.text() + " (both " + to_string(pdo.cob_id) +
            (stated ? ", which " + fed.node->dictionary->file + " sets" : "") +
            "); the master does not send this RPDO" +
            (stated ? ". Write `cob_id: auto` for it under `rpdo:` if the master shall send it"
                    : ""));
  }

  void claim_of_device(NodePdos& node, EffectivePdo& pdo) {
    const User user{&pdo, &node.node};
    const std::string service = service_at(pdo.cob_id);
    const auto other = used_.find(pdo.cob_id);
    if (service.empty() && other == used_.end()) {
      take(node, pdo, pdo.cob_id);
    } else if (service.empty() && is_link(node, pdo, other->second)) {
      link(pdo, other->second, user);
    } else {
      move(node, pdo, service.empty() ? &other->second : nullptr, service);
    }
  }

  /// Returns true if `pdo` and `other`, which have the same COB-ID, form a link that a device file
  /// states together with the network file or another device file. There is no link if the master
  /// is to send the RPDO (the network file mentions it without a COB-ID), or if both COB-IDs are
  /// only the predefined ones of their nodes.
  static bool is_link(const NodePdos& node, const EffectivePdo& pdo, const User& other) {
    if (pdo.is_tpdo == other.pdo->is_tpdo || other.node == &node.node) return false;
    if (other.pdo->origin == CobIdOrigin::network_file) return pdo.is_tpdo || !pdo.named;
    return !pdo.is_tpdo && !pdo.named && !is_own(node, pdo);
  }

  /// Returns true if the network file gives one PDO the COB-ID with which another PDO is sent
  /// according to its device file.
  static bool is_clash(const EffectivePdo& pdo, const User* other) {
    return pdo.is_tpdo && other != nullptr && other->pdo->origin == CobIdOrigin::network_file;
  }

  void report_clash(const User& user, const User& other, std::uint32_t free) {
    report_.error(other.pdo->cob_id_pos, "cob-id-clash",
                  "`cob_id` " + to_string(other.pdo->cob_id) + " of " + other.text() +
                      " is also used by " + user.text() + " in " + user.node->dictionary->file +
                      ": write `cob_id: auto` for one of them (" + user.text() + " would get " +
                      hex(free, 3) + ")");
  }

  /// Gives a PDO another COB-ID. `other` is the PDO that already has the current one; if it is
  /// nullptr, `service` says why no PDO may have it.
  void move(NodePdos& node, EffectivePdo& pdo, const User* other, const std::string& service) {
    const User user{&pdo, &node.node};
    const CobId was = pdo.cob_id;
    const std::uint32_t free = automatic(node, pdo);
    if (free == 0) return none_free(user, pdo);
    const CobId id = CobId::base(free);
    if (is_clash(pdo, other)) {
      report_clash(user, *other, free);
      pdo.origin = CobIdOrigin::automatic;
      return take(node, pdo, id);
    }
    const std::string text = user.text() + " has COB-ID " + to_string(was) + " in " +
                             node.node.dictionary->file + ", which " +
                             (other == nullptr ? service : "is used by " + other->text()) +
                             "; takt uses " + to_string(id);
    const bool cut =
        other != nullptr && other->node != &node.node && other->pdo->is_tpdo != pdo.is_tpdo;
    if (cut) {
      report_.warning(pdo.cob_id_pos, "cob-id-moved",
                      text +
                          ". If the two devices shall exchange data with this id, write "
                          "`cob_id: " +
                          to_string(was) +
                          "` for both PDOs; if not, `cob_id: " + "auto` for this one");
    } else {
      report_.note(pdo.cob_id_pos, "cob-id-moved", text);
    }
    pdo.origin = CobIdOrigin::automatic;
    take(node, pdo, id);
  }

  void none_free(const User& user, const EffectivePdo& pdo) {
    report_.error(pdo.cob_id_pos, "cob-id",
                  "no COB-ID is free for " + user.text() + " in 0x181..0x57F");
  }

  /// Gives a TPDO its predefined COB-ID. If an RPDO of another device has this COB-ID in the
  /// network file, they are a link. Otherwise a COB-ID that is taken remains with its owner.
  void claim_predefined(NodePdos& node, EffectivePdo& pdo) {
    const CobId id = CobId::base(predefined(pdo, node.node.id));
    if (!service_at(id).empty()) return;
    const auto other = used_.find(id);
    if (other == used_.end()) return take(node, pdo, id);
    if (!is_link(node, pdo, other->second)) return;
    pdo.cob_id = id;
    pdo.has_cob_id = true;
    link(pdo, other->second, {&pdo, &node.node});
  }

  void claim_automatic(NodePdos& node, EffectivePdo& pdo) {
    const std::uint32_t id = automatic(node, pdo);
    if (id == 0) return none_free({&pdo, &node.node}, pdo);
    if (pdo.number <= 4 && id != predefined(pdo, node.node.id)) report_taken(node, pdo, id);
    take(node, pdo, CobId::base(id));
  }

  /// Reports that a PDO can't have its predefined COB-ID. This is an error if the network file
  /// gives it to two TPDOs: to one by its number, to the other one by `auto`.
  void report_taken(const NodePdos& node, EffectivePdo& pdo, std::uint32_t free) {
    const User user{&pdo, &node.node};
    const CobId own = CobId::base(predefined(pdo, node.node.id));
    const auto other = used_.find(own);
    const bool is_twice = other != used_.end() && pdo.is_tpdo && other->second.pdo->is_tpdo &&
                          other->second.pdo->origin == CobIdOrigin::network_file;
    if (is_twice) {
      const User& owner = other->second;
      report_.error(owner.pdo->cob_id_pos, "cob-id-clash",
                    "`cob_id` " + to_string(own) + " of " + owner.text() +
                        " is the predefined COB-ID of " + user.text() +
                        ", which has no `cob_id` of its own: write `cob_id: " + hex(free, 3) +
                        "` for " + user.text() + ", or another `cob_id` for " + owner.text());
      return;
    }
    report_.note(
        pdo.cob_id_pos, "cob-id-moved",
        "the predefined COB-ID " + to_string(own) + " of " + user.text() + " " +
            (other == used_.end() ? service_at(own) : "is used by " + other->second.text()) +
            "; takt uses " + hex(free, 3));
  }

  /// Returns the predefined COB-ID if it is free, else the lowest free identifier. Identifiers
  /// outside the predefined connection set are preferred.
  std::uint32_t automatic(const NodePdos& node, const EffectivePdo& pdo) const {
    if (pdo.number <= 4) {
      const std::uint32_t own = predefined(pdo, node.node.id);
      if (!used_.contains(CobId::base(own)) && service_at(CobId::base(own)).empty()) return own;
    }
    for (const bool spare_predefined : {true, false}) {
      for (std::uint32_t id = first_free; id <= last_free; ++id) {
        if (!used_.contains(CobId::base(id)) && !(spare_predefined && is_predefined(id)) &&
            service_at(CobId::base(id)).empty()) {
          return id;
        }
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

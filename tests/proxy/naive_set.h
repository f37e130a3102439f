/** The rules of proxy.h written down with arrays and loops: an oracle for tests. */
#ifndef TESTS_PROXY_NAIVE_SET_H
#define TESTS_PROXY_NAIVE_SET_H

#include <sluice/proxy.h>

enum naive_state { NAIVE_NEW, NAIVE_LIVE, NAIVE_REMOVED, NAIVE_FREE };

struct naive_proxy {
    enum naive_state state;
    uint32_t generation;
    bool requested, noted;
    uint64_t launch; ///< removed: the last that may name it, if it is noted
    SluiceProxyBox box;
};

struct naive_set {
    struct naive_proxy *proxies;
    uint32_t capacity;
};

void naive_init(struct naive_set *set, uint32_t capacity);
void naive_finish(struct naive_set *set);
SluiceProxyId naive_add(struct naive_set *set, const SluiceProxyBox *box);
void naive_remove(struct naive_set *set, uint32_t index);
void naive_request(struct naive_set *set, uint64_t begun, uint64_t processed, uint32_t count,
                   const uint32_t *indices);
/** Ids of requested proxies in the order of `info`, all of them. Returns how many. */
uint32_t naive_list(const struct naive_set *set, const SluiceProxyListInfo *info,
                    SluiceProxyId *ids);

#endif /* TESTS_PROXY_NAIVE_SET_H */

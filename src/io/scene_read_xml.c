/* SPDX-License-Identifier: GPL-3.0-or-later */
/* First part of the scene reader: bytes -> tree of elements, with $parameters replaced. It refuses what could grow
 * without bound: document types and entities, deep nesting, too many elements, parameters that multiply. */
#include <expat.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/scene_read_c.h"

#define LETTERS "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"

struct parse {
    struct reader *r;
    XML_Parser xml;
    struct node *current;
};

/* ---- messages and memory ---- */

static int fail_at(struct reader *r, int line, const char *format, va_list args)
{
    if (r->status == LC_OK) {
        char text[900];
        vsnprintf(text, sizeof text, format, args);
        r->status = lc_fail(r->err, LC_BAD_INPUT, "%s:%d: %s", r->name, line, text);
    }
    return 0;
}

int scene_fail(struct reader *r, const struct node *node, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    fail_at(r, node ? node->line : 1, format, args);
    va_end(args);
    return 0;
}

int scene_no_memory(struct reader *r)
{
    if (r->status == LC_OK)
        r->status = lc_fail(r->err, LC_FAULT, "%s: out of memory while reading it", r->name);
    return 0;
}

enum { CHUNK = 1 << 16 };

struct chunk {
    struct chunk *next;
    size_t used, size;
    double bytes[]; /* double: aligned for all that is stored here */
};

void *scene_alloc(struct reader *r, size_t size)
{
    size = (size + sizeof(double) - 1) / sizeof(double) * sizeof(double);
    if (!r->chunks || r->chunks->size - r->chunks->used < size) {
        size_t room = size > CHUNK ? size : CHUNK;
        struct chunk *chunk = calloc(1, sizeof *chunk + room);
        if (!chunk) {
            scene_no_memory(r);
            return NULL;
        }
        chunk->size = room;
        chunk->next = r->chunks;
        r->chunks = chunk;
    }
    void *p = (char *)r->chunks->bytes + r->chunks->used;
    r->chunks->used += size;
    return p;
}

void scene_free(struct reader *r)
{
    while (r->chunks) {
        struct chunk *next = r->chunks->next;
        free(r->chunks);
        r->chunks = next;
    }
}

static char *copy(struct reader *r, const char *text, size_t length)
{
    char *out = scene_alloc(r, length + 1);
    if (out)
        memcpy(out, text, length);
    return out;
}

/* ---- attributes ---- */

const char *scene_attribute(const struct node *node, const char *name)
{
    for (int i = 0; i < node->attribute_count; ++i)
        if (strcmp(node->attributes[i].name, name) == 0)
            return node->attributes[i].value;
    return NULL;
}

int scene_word_in(const char *words, const char *word)
{
    size_t length = strlen(word);
    for (const char *w = words; *w; w += *w == ' ') {
        size_t n = strcspn(w, " ");
        if (n == length && memcmp(w, word, n) == 0)
            return 1;
        w += n;
    }
    return 0;
}

int scene_attributes_only(struct reader *r, const struct node *node, const char *names)
{
    for (int i = 0; i < node->attribute_count; ++i)
        if (!scene_word_in(names, node->attributes[i].name))
            return scene_fail(r, node, "unknown attribute '%.40s' of <%s>; supported: %s", node->attributes[i].name,
                              node->tag, *names ? names : "none");
    return 1;
}

/* The parameter with the longest name that `text` begins with, as Mitsuba looks them up; NULL when there is none. */
static const struct parameter *parameter_at(const struct reader *r, const char *text)
{
    const struct parameter *best = NULL;
    for (int i = 0; i < r->parameter_count; ++i) {
        const struct parameter *p = &r->parameters[i];
        if ((!best || p->length > best->length) && strncmp(text, p->name, p->length) == 0)
            best = p;
    }
    return best;
}

/* Writes the text with every $name replaced to `out` unless that is NULL; returns the length, or -1 after a failure. */
static long expand(struct reader *r, const struct node *node, const char *text, char *out)
{
    long length = 0;
    while (*text) {
        if (*text != '$' && !(text[0] == '\\' && text[1] == '$')) {
            if (out)
                out[length] = *text;
            ++length, ++text;
            continue;
        }
        if (*text == '\\') { /* \$ is a dollar sign */
            if (out)
                out[length] = '$';
            ++length, text += 2;
            continue;
        }
        const struct parameter *p = parameter_at(r, text + 1);
        if (!p) {
            scene_fail(r, node, "undefined parameter '%.40s'; expected a <default> for it further up", text);
            return -1;
        }
        size_t n = strlen(p->value);
        if (out)
            memcpy(out + length, p->value, n);
        length += (long)n;
        text += 1 + p->length;
        if (length > LC_SCENE_MAX_BYTES)
            break;
    }
    return length;
}

static const char *expanded(struct reader *r, const struct node *node, const char *text)
{
    if (!strchr(text, '$'))
        return copy(r, text, strlen(text));
    long length = expand(r, node, text, NULL);
    if (length < 0)
        return NULL;
    r->expanded += (size_t)length;
    if (r->expanded > LC_SCENE_MAX_BYTES) {
        scene_fail(r, node, "the parameters make the file longer than %d bytes", LC_SCENE_MAX_BYTES);
        return NULL;
    }
    char *out = scene_alloc(r, (size_t)length + 1);
    if (out)
        expand(r, node, text, out);
    return out;
}

/* <default name="..." value="..."/>: from here on $name is its value, or what the caller gave instead. */
static int add_parameter(struct reader *r, const struct node *node)
{
    const char *name = scene_attribute(node, "name"), *value = scene_attribute(node, "value");
    if (!scene_attributes_only(r, node, "name value"))
        return 0;
    if (!name || !value || !*name || strspn(name, LETTERS "0123456789_") != strlen(name))
        return scene_fail(r, node, "bad <default>; expected name=\"letters, digits, _\" and a value");
    if (strcmp(node->parent->tag, "scene") != 0)
        return scene_fail(r, node, "<default> inside <%s>; expected it directly in <scene>", node->parent->tag);
    for (int i = 0; i < r->parameter_count; ++i)
        if (strcmp(r->parameters[i].name, name) == 0)
            return scene_fail(r, node, "a second <default> for '%.60s'", name);
    if (r->parameter_count == MAX_PARAMETERS)
        return scene_fail(r, node, "more than %d <default> elements", MAX_PARAMETERS);
    for (int i = 0; i < r->override_count; ++i)
        if (strcmp(r->overrides[i].name, name) == 0)
            value = r->overrides[i].value;
    struct parameter *p = &r->parameters[r->parameter_count++];
    p->name = name, p->value = value, p->length = strlen(name);
    return 1;
}

static int overrides_used(struct reader *r)
{
    for (int i = 0; i < r->override_count; ++i) {
        int found = 0;
        for (int j = 0; j < r->parameter_count; ++j)
            found |= strcmp(r->overrides[i].name, r->parameters[j].name) == 0;
        if (found)
            continue;
        char known[400] = "";
        for (int j = 0; j < r->parameter_count; ++j)
            snprintf(known + strlen(known), sizeof known - strlen(known), "%s%s", j ? ", " : "", r->parameters[j].name);
        return scene_fail(r, r->root, "no <default> for parameter '%.60s'; the file has: %s", r->overrides[i].name,
                          *known ? known : "none");
    }
    return 1;
}

/* ---- elements ---- */

static struct node *new_node(struct parse *p, const char *tag, const char **attributes)
{
    struct reader *r = p->r;
    struct node *node = scene_alloc(r, sizeof *node);
    if (!node)
        return NULL;
    node->line = (int)XML_GetCurrentLineNumber(p->xml);
    node->parent = p->current;
    node->depth = p->current ? p->current->depth + 1 : 0;
    node->material = -1;
    if (!(node->tag = copy(r, tag, strlen(tag))))
        return NULL;
    int count = 0;
    while (attributes[2 * count])
        ++count;
    if (!(node->attributes = scene_alloc(r, (size_t)count * sizeof *node->attributes)))
        return NULL;
    for (int i = 0; i < count; ++i) {
        struct attribute *a = &node->attributes[i];
        a->name = copy(r, attributes[2 * i], strlen(attributes[2 * i]));
        a->value = a->name ? expanded(r, node, attributes[2 * i + 1]) : NULL;
        if (!a->value)
            return NULL;
        node->attribute_count = i + 1;
    }
    return node;
}

static void XMLCALL on_start(void *user, const XML_Char *tag, const XML_Char **attributes)
{
    struct parse *p = user;
    struct reader *r = p->r;
    if (r->status != LC_OK)
        return;
    struct node *node = new_node(p, tag, attributes);
    if (!node)
        goto stop;
    if (node->depth > MAX_DEPTH) {
        scene_fail(r, node, "elements nested more than %d deep", MAX_DEPTH);
        goto stop;
    }
    if (++r->node_count > MAX_NODES) {
        scene_fail(r, node, "more than %d elements", MAX_NODES);
        goto stop;
    }
    if (node->parent && strcmp(node->parent->tag, "default") == 0) {
        scene_fail(r, node, "<%.40s> inside <default>", tag);
        goto stop;
    }
    if (!node->parent)
        r->root = node;
    else if (strcmp(tag, "default") == 0) {
        if (!add_parameter(r, node))
            goto stop;
    } else {
        if (node->parent->last)
            node->parent->last->next = node;
        else
            node->parent->first = node;
        node->parent->last = node;
    }
    p->current = node;
    r->id_count += scene_attribute(node, "id") != NULL;
    return;
stop:
    XML_StopParser(p->xml, XML_FALSE);
}

static void XMLCALL on_end(void *user, const XML_Char *tag)
{
    struct parse *p = user;
    (void)tag;
    if (p->r->status == LC_OK)
        p->current = p->current->parent;
}

static void stop_here(struct parse *p, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    fail_at(p->r, (int)XML_GetCurrentLineNumber(p->xml), format, args);
    va_end(args);
    XML_StopParser(p->xml, XML_FALSE);
}

static void XMLCALL on_text(void *user, const XML_Char *text, int length)
{
    struct parse *p = user;
    for (int i = 0; i < length; ++i)
        if (p->r->status == LC_OK && !strchr(" \t\r\n", text[i])) {
            stop_here(p, "text between elements; expected elements and comments only");
            return;
        }
}

/* Entities are how a small file becomes a huge one. */
static void XMLCALL on_doctype(void *user, const XML_Char *name, const XML_Char *system, const XML_Char *public_id,
                               int internal)
{
    (void)name, (void)system, (void)public_id, (void)internal;
    stop_here(user, "a document type; entities are not supported");
}

/* ---- ids ---- */

static int compare_ids(const void *a, const void *b)
{
    const struct node *x = *(struct node *const *)a, *y = *(struct node *const *)b;
    int order = strcmp(scene_attribute(x, "id"), scene_attribute(y, "id"));
    return order ? order : (x->line > y->line) - (x->line < y->line);
}

static struct node *next_in_order(struct node *node)
{
    if (node->first)
        return node->first;
    while (node && !node->next)
        node = node->parent;
    return node ? node->next : NULL;
}

/* <ref id="..."/> names another element, any other element itself. */
static int collect_ids(struct reader *r)
{
    int count = 0;
    if (!(r->by_id = scene_alloc(r, (size_t)(r->id_count + 1) * sizeof *r->by_id)))
        return 0;
    for (struct node *n = r->root; n; n = next_in_order(n))
        if (scene_attribute(n, "id") && strcmp(n->tag, "ref") != 0)
            r->by_id[count++] = n;
    r->id_count = count;
    qsort(r->by_id, (size_t)count, sizeof *r->by_id, compare_ids);
    for (int i = 1; i < count; ++i) {
        const char *id = scene_attribute(r->by_id[i], "id");
        if (strcmp(id, scene_attribute(r->by_id[i - 1], "id")) == 0)
            return scene_fail(r, r->by_id[i], "id '%.60s' is already taken by line %d", id, r->by_id[i - 1]->line);
    }
    return 1;
}

struct node *scene_find(const struct reader *r, const char *id)
{
    int low = 0, high = r->id_count;
    while (low < high) {
        int middle = (low + high) / 2, order = strcmp(id, scene_attribute(r->by_id[middle], "id"));
        if (order == 0)
            return r->by_id[middle];
        if (order < 0)
            high = middle;
        else
            low = middle + 1;
    }
    return NULL;
}

int scene_parse(struct reader *r, const char *text, size_t length)
{
    struct parse p = {r, NULL, NULL};
    if (length > LC_SCENE_MAX_BYTES)
        return scene_fail(r, NULL, "a file of more than %d bytes", LC_SCENE_MAX_BYTES);
    if (!(p.xml = XML_ParserCreate(NULL)))
        return scene_no_memory(r);
    XML_SetUserData(p.xml, &p);
    XML_SetElementHandler(p.xml, on_start, on_end);
    XML_SetCharacterDataHandler(p.xml, on_text);
    XML_SetStartDoctypeDeclHandler(p.xml, on_doctype);
    enum XML_Status status = XML_Parse(p.xml, text, (int)length, 1);
    if (status != XML_STATUS_OK && r->status == LC_OK) {
        if (XML_GetErrorCode(p.xml) == XML_ERROR_NO_MEMORY)
            scene_no_memory(r);
        else
            stop_here(&p, "not well-formed XML: %s", XML_ErrorString(XML_GetErrorCode(p.xml)));
    }
    XML_ParserFree(p.xml);
    return r->status == LC_OK && collect_ids(r) && overrides_used(r);
}

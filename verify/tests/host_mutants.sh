#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# usage: host_mutants.sh [--fits | NAME ...]
# Hosts that are wrong on purpose: each is made by one substitution in a copy of the tree, and some test must fail.
# Prints mutant and the tests that killed it. Exit status 0: all are dead; 1: one lives, or could not be made.
set -eu
cd "$(dirname "$0")/../.."
what=host
suites='bsdf warp sampler film camera accel surface render nee effects motion pool'
. verify/tests/wrong_copy.sh

bsdf=src/core/bsdf.c glossy=src/core/glossy.c surface=src/core/surface.c warp=src/core/warp.c
sampler=src/core/sampler.c film=src/core/film.c camera=src/core/camera.c light=src/core/light.c
solid=src/core/solid_angle.c accel=src/core/accel.c render=src/core/render.c scene=src/core/scene.c

# BSDF.
mutant diffuse_without_pi $bsdf 's/lc_rgb_scale(LC_INV_PI, m->diffuse)/m->diffuse/' bsdf
mutant albedo_squared $bsdf 's/lc_rgb_scale(LC_INV_PI, m->diffuse)/lc_rgb_scale(LC_INV_PI, lc_rgb_mul(m->diffuse, m->diffuse))/' bsdf
mutant value_on_both_sides $bsdf 's/if (!(lc_dot(hit->n, wi) \* lc_dot(hit->n, hit->wo) > 0))/if (0)/' bsdf
mutant density_without_the_lobes_share $bsdf 's/pdf = diffuse \/ reflectance(m) \* fabs(cos_i)/pdf = fabs(cos_i)/' bsdf
mutant lobes_not_in_their_shares $bsdf '/left -= weight\[i\];/d' bsdf
mutant mirror_of_density_one $bsdf 's/scatter.pdf = weight\[way\] \/ total;/scatter.pdf = 1;/' bsdf
mutant back_has_the_fronts_material $surface 's/desc->side\[is_front(hit) ? 0 : 1\]/desc->side[0]/' bsdf surface
mutant fresnel_cosines_exchanged $bsdf 's/double s = (cos_i - ior \* cos_t) \/ (cos_i + ior \* cos_t);/double s = (cos_t - ior * cos_i) \/ (cos_t + ior * cos_i);/' bsdf
mutant fresnel_by_schlick $bsdf 's/return 0.5 \* (s \* s + p \* p);/return (s - p) * 0 + (ior - 1) * (ior - 1) \/ ((ior + 1) * (ior + 1)) + 4 * ior * pow(1 - cos_i, 5) \/ ((ior + 1) * (ior + 1));/' bsdf
mutant total_reflection_forgotten $bsdf 's/return 1.0;/return 0.0;/' bsdf
mutant glass_without_eta_squared $bsdf 's/ \/ (m->ior \* m->ior));/);/' bsdf
mutant glass_with_eta_squared_inverted $bsdf 's/ \/ (m->ior \* m->ior));/ * (m->ior * m->ior));/' bsdf
mutant index_the_same_from_inside $surface 's/desc->ext_ior \/ desc->int_ior;/desc->int_ior \/ desc->ext_ior;/' bsdf surface
mutant refracted_to_the_wrong_angle $bsdf 's/lc_scale(cos_i \/ ior - sqrt(cos2_t), n)/lc_scale(cos_i * ior - sqrt(cos2_t), n)/' bsdf
mutant ggx_density_half $glossy 's/ \/ (2 \* (cos_o + root(cos_o, alpha)));/ \/ (4 * (cos_o + root(cos_o, alpha)));/' effects
mutant ggx_of_roughness_not_squared $glossy 's/a2 = alpha \* alpha,/a2 = alpha,/' effects
mutant ggx_masked_one_way_only $glossy 's/(cos_i + root(cos_i, alpha))/(2 * cos_i)/' effects
mutant ggx_not_stretched_back $glossy 's/lc_vec(alpha \* h.x, alpha \* h.y, h.z)/lc_vec(h.x, h.y, h.z)/' effects
mutant ggx_normals_seen_from_above $glossy 's/lc_vec(alpha \* lc_dot(s, wo), alpha \* lc_dot(t, wo), lc_dot(n, wo))/lc_vec(0, 0, lc_dot(n, wo))/' effects

# Warps.
mutant uniform_hemisphere_by_cosine $warp 's/double cos_theta = 1.0 - u;/double cos_theta = sqrt(1.0 - u);/; s/sqrt(u \* (2.0 - u)), v)/sqrt(u), v)/' warp
mutant cosine_hemisphere_is_uniform $warp 's/sqrt(1.0 - u), sqrt(u), v)/1.0 - u, sqrt(u * (2.0 - u)), v)/' warp
mutant disk_without_root $warp 's/sqrt(1.0 - u), sqrt(u), v)/sqrt(1.0 - u * u), u, v)/' warp
mutant sphere_uniform_in_the_angle $warp 's/double z = 1.0 - 2.0 \* u, r = 2.0 \* sqrt(u \* (1.0 - u)), x, y;/double z = cos(LC_PI * u), r = sin(LC_PI * u), x, y;/' warp
mutant half_a_turn $warp 's/(v - 0.5) \* (0.5 \* LC_PI)/(v - 0.5) * (0.25 * LC_PI)/' warp
mutant frame_breaks_below $warp 's/copysign(1.0, n.z)/1.0/' warp
mutant lamp_disk_without_root $light 's/double r = sqrt(u), phi/double r = u, phi/' warp
mutant lamp_rectangle_a_quarter $light 's/lc_scale(2.0 \* u - 1.0, face->eu), lc_scale(2.0 \* v - 1.0, face->ev)/lc_scale(u, face->eu), lc_scale(v, face->ev)/' warp
mutant lamp_cube_by_sides_not_area $light 's/area >= scene->faces\[part\].area)/area >= shape->area \/ 6)/; s/area -= scene->faces\[part++\].area;/area -= shape->area \/ 6, ++part;/' warp
mutant number_not_stretched_again $light 's/shape->count > 1 ? fmin(area \/ scene->faces\[part\].area, 1.0) : u/u/' warp
mutant cap_as_flat_disk $solid 's/most = sin2 \/ (1.0 + sqrt(1.0 - sin2)), x/most = 0.5 * sin2, x/' nee
mutant cap_uniform_in_the_angle $solid 's/x = u \* most, /x = u * u * most, /' nee
mutant sphere_from_within_twice_as_dense $solid 's/out->pdf_solid = 0.25 \* LC_INV_PI;/out->pdf_solid = 0.5 * LC_INV_PI;/' nee
mutant rectangle_uniform_in_its_height $solid 's/    yv = fmax(q->y0, fmin(q->y1, yv));/    yv = q->y0 + v * (q->y1 - q->y0);/' nee
mutant rectangle_of_the_wrong_solid_angle $solid 's/q->solid = angle_between(n0, n1)/q->solid = angle_between(n0, n2)/' nee

# The sampler.
mutant arm_ignored $sampler 's/sampler->sample, sampler->arm}}/sampler->sample, 0}}/' sampler
mutant sample_number_dropped $sampler 's/sampler->sample, sampler->arm}}/0, sampler->arm}}/' sampler
mutant pixel_dropped $sampler 's/{{index, sampler->pixel,/{{index, 0,/' sampler
mutant half_the_seed $sampler 's/(uint32_t)(sampler->seed >> 32)}}/0}}/' sampler
mutant numbers_used_again $sampler 's/        load_block(sampler, index);/        load_block(sampler, index \& 1);/' sampler
mutant lane_used_again $sampler 's/lane = sampler->dimension & 3;/lane = sampler->dimension \& 2;/' sampler
mutant one_is_reached $sampler 's/sampler->block\[lane\] \* 0x1p-32/sampler->block[lane] \/ 4294967295.0/' sampler
mutant numbers_of_24_bits $sampler 's/sampler->block\[lane\] \* 0x1p-32/(sampler->block[lane] >> 8) * 0x1p-24/' sampler
mutant numbers_rounded_to_float $sampler 's/sampler->block\[lane\] \* 0x1p-32/(float)(sampler->block[lane] * 0x1p-32)/' sampler

# The film.
mutant variance_over_n $film 's/m2 \/ (n \* (n - 1));/m2 \/ (n * n);/' film
mutant variance_of_one_sample $film 's/m2 \/ (n \* (n - 1));/m2 \/ (n - 1);/' film
mutant spread_between_parts_lost $film 's/m->m2 += o->m2 + square;/m->m2 += o->m2;/' film
mutant third_moment_without_cross_term $film 's/ + 3 \* delta \* (share_a \* o->m2 - share_b \* m->m2);/;/' film
mutant merge_ignores_counts $film 's/double share_a = a \* inverse, share_b = b \* inverse;/double share_a = 0.5 + 0 * inverse, share_b = 0.5;/' film
mutant batches_forgotten $film 's/if (from->batches == 0)/if (1)/' film
mutant short_blocks_are_batches $film 's/(uint64_t)count, count == LC_BLOCK,/(uint64_t)count, 1,/' film
mutant largest_is_the_last $film 's/m->max = o->max > m->max ? o->max : m->max;/m->max = o->max;/' film
mutant tail_of_a_block_lost $film 's/for (int j = 0; i + j < size; ++j) {/for (int j = 0; i + j + 3 < size; ++j) {/' film
mutant same_samples_counted_twice $film 's/if (same && gap < a->count)/if (0)/' film
mutant shards_shifted $film 's/has_shard(from, tile % from->shards)/has_shard(from, (tile + 1) % from->shards)/' film
mutant shadow_rays_not_counted src/core/light.c '/lc_count_ray();/d' render
mutant rays_not_counted src/core/surface.c '/^    lc_count_ray();/d' render
mutant rays_of_all_samples src/core/surface.c 's/{ ray_count = 0; }/{ }/' render
mutant numbers_of_the_camera_counted src/core/surface.c 's/ - (double)LC_DIMENSION_ESTIMATOR//' render
mutant costs_are_radiance $render 's/if (o->costs)$/if (0)/' render
mutant last_block_not_added $render 's/ || s + 1 == o->first + o->count)/)/' render

# Processes.
mutant forked_with_threads verify/grade/pool.c 's/return threads <= 1 ? LC_OK/return threads > 0 ? LC_OK/' pool

# The camera.
mutant half_a_pixel_off $camera 's/x + dx, y + dy/x + dx - 0.5, y + dy - 0.5/g' camera
mutant pinhole_half_a_pixel_off $camera 's/return lc_camera_frame_ray(frame, x + dx, y + dy);/return lc_camera_frame_ray(frame, x + dx - 0.5, y + dy - 0.5);/' camera
mutant pixels_by_their_centres $camera 's/return lc_camera_frame_ray(frame, x + dx, y + dy);/return lc_camera_frame_ray(frame, x + 0.5, y + 0.5);/' camera
mutant field_of_view_along_the_other_axis $camera 's/return aspect > 1.0 ? t \* aspect : t;/return aspect > 1.0 ? t : t * aspect;/' camera
mutant mirrored_image $camera 's/lc_vec(t, t \/ aspect, 1)/lc_vec(-t, t \/ aspect, 1)/; s/lc_vec(-2 \* t \/ width, 0, 0)/lc_vec(2 * t \/ width, 0, 0)/' camera
mutant lens_without_root $camera 's/double r = sqrt(u), phi/double r = u, phi/' camera
mutant everything_out_of_focus $camera 's/lc_scale(1 \/ frame->focus, offset)/lc_scale(1, offset)/' camera
mutant far_clip_along_the_ray $camera 's/lc_dot(axis, lc_sub(hit->p, eye)) > /lc_length(lc_sub(hit->p, eye)) + 0 * axis.x > /' camera
mutant time_of_32_bits $camera 's/ray.time = floor(lc_next(sampler) \* 0x1p24) \* 0x1p-24;/ray.time = lc_next(sampler);/' motion

# Lights.
mutant light_without_its_area $light 's/sample_area(scene, light->index, 1.0 \/ scene->shapes\[light->index\].area,/sample_area(scene, light->index, 1.0,/' warp
mutant hit_density_without_area $light 's/emits ? 1.0 \/ scene->shapes\[hit->shape\].area : 0.0/emits ? 1.0 : 0.0/' nee
mutant union_with_the_density_of_one $light 's/lights\[i\].index, 1.0 \/ total,/lights[i].index, 1.0 \/ scene->shapes[scene->lights[i].index].area,/' warp
mutant delta_lights_not_counted $scene 's/scene->lights\[scene->light_count++\] = (lc_light){LC_LIGHT_POINT, i};/scene->lights[scene->light_count] = (lc_light){LC_LIGHT_POINT, i};/' warp
mutant point_without_falloff $light 's/lc_rgb_scale(1.0 \/ (out->distance \* out->distance), point->intensity)/point->intensity/' warp
mutant sun_from_behind $light 's/out->wi = lc_neg(directional->direction);/out->wi = directional->direction;/' warp
mutant lamps_shine_backwards $surface 's/else if (is_front(hit))/else/' surface
mutant flipped_normals_ignored $scene 's/round->sign = desc->flip_normals ? -1.0 : 1.0;/round->sign = 1.0;/' warp
mutant normal_lost_in_a_mirrored_pose $scene 's/(lc_affine_determinant(to_world) < 0) != (flip != 0)/flip != 0/' surface
mutant moving_light_sampled_at_rest $light 's/lc_shape_shift(scene, shape, hit->time));/lc_shape_shift(scene, shape, 0));/' motion
mutant moving_cone_aimed_at_rest $light 's/seen.p = lc_sub(hit->p, shift);/seen.p = hit->p;/' motion
mutant moving_cone_left_at_rest $light 's/out->p = lc_add(out->p, shift);/out->p = lc_add(out->p, lc_scale(0, shift));/' motion
mutant moving_texture_stays $surface 's/hit->part, lc_rest_point(scene, hit))/hit->part, hit->p)/' motion

# Rays.
mutant rays_start_on_the_surface $accel 's/double offset = start->offset + extra;/double offset = extra;/' accel
mutant rays_start_at_the_very_edge $accel 's/if (fabs(u) > most_u)/if (0)/; s/if (fabs(v) > most_v)/if (0)/' accel
mutant ray_meets_the_sphere_it_leaves $accel 's/part == q->from, part == q->to/0, part == q->to/' accel
mutant shadow_of_the_light_itself $accel 's/part == q->from, part == q->to/part == q->from, 0/' accel
mutant shadows_of_time_0 $accel 's/    ray->time = (float)time;/    ray->time = 0;/' motion
mutant spheres_stay_at_rest $accel 's/lc_scale(q->time, round->motion)/lc_scale(0, round->motion)/' motion
mutant points_in_single_precision $accel 's/hit->p = lc_add(o, lc_scale(t, d));/hit->p = lc_add(o, lc_scale((float)t, d));/' accel

sum_up

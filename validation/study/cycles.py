# Renders one diffuse scene in Blender's Cycles, as often as asked, in the setting that costs Cycles the least time for its error.
#
#   blender -b --factory-startup -noaudio -t THREADS --debug-cycles -P cycles.py -- JOB.json
#
# JOB.json names a .glb, a camera, the light and the limits (validation/study/cycles.cpp writes it). Each line on standard input,
# {"spp": n, "seed": s, "out": "file.exr"}, is one render, answered by a line `plumbline: {"seconds": …}`; the end of the input
# ends Blender. So renders of two programs can take turns without Blender being started anew.
#
# Frames: the job is Y-up, Blender Z-up: (x, y, z) becomes (x, -z, y), and the lat-long image needs no rotation.
import json
import math
import sys
import time

import bpy
import numpy
from mathutils import Matrix, Vector


def to_blender(v):
    return Vector((v[0], -v[2], v[1]))


def say(**values):
    print('plumbline: ' + json.dumps(values), flush=True)


def load_mesh(job):
    # Blender 3.4's glTF importer still says numpy.bool, which NumPy 1.24 (both in Debian 12) has no more.
    if 'bool' not in vars(numpy):
        numpy.bool = bool
    bpy.ops.wm.read_factory_settings(use_empty=True)
    shading = 'NORMALS' if job['has_smooth_normals'] else 'FLAT'
    bpy.ops.import_scene.gltf(filepath=job['scene'], import_shading=shading, merge_vertices=False)
    for thing in list(bpy.context.scene.objects):
        if thing.type != 'MESH':
            bpy.data.objects.remove(thing)  # the job's camera counts
            continue
        # Factory 0.1 moves shadow rays' origins on smooth surfaces.
        thing.cycles.shadow_terminator_geometry_offset = 0.0
        thing.cycles.shadow_terminator_offset = 0.0
        for slot in thing.material_slots:
            if slot.material is not None:
                make_diffuse(slot.material, job['has_dark_backs'])


def make_diffuse(material, has_dark_backs):
    """A Lambertian surface, or a light that shines from its front, instead of the importer's Principled BSDF."""
    tree = material.node_tree
    principled = next((n for n in tree.nodes if n.type == 'BSDF_PRINCIPLED'), None)
    if principled is None:
        return  # shared by two meshes and done already
    base = principled.inputs['Base Color']
    strength = principled.inputs['Emission Strength'].default_value
    radiance = [c * strength for c in principled.inputs['Emission'].default_value[:3]]
    surface = tree.nodes.new('ShaderNodeBsdfDiffuse')
    surface.inputs['Roughness'].default_value = 0.0  # above 0 it is Oren-Nayar
    surface.inputs['Color'].default_value = base.default_value
    if base.is_linked:
        tree.links.new(base.links[0].from_socket, surface.inputs['Color'])
    is_one_sided = material.use_backface_culling
    front = surface.outputs[0]
    if max(radiance) > 0.0:
        emission = tree.nodes.new('ShaderNodeEmission')
        emission.inputs['Color'].default_value = (*radiance, 1.0)
        emission.inputs['Strength'].default_value = 1.0
        front = emission.outputs[0]
        if base.is_linked or max(base.default_value[:3]) > 0.0:
            both = tree.nodes.new('ShaderNodeAddShader')
            tree.links.new(surface.outputs[0], both.inputs[0])
            tree.links.new(emission.outputs[0], both.inputs[1])
            front = both.outputs[0]
    if is_one_sided and (has_dark_backs or max(radiance) > 0.0):
        geometry = tree.nodes.new('ShaderNodeNewGeometry')
        black = tree.nodes.new('ShaderNodeBsdfDiffuse')
        black.inputs['Color'].default_value = (0.0, 0.0, 0.0, 1.0)
        side = tree.nodes.new('ShaderNodeMixShader')
        tree.links.new(geometry.outputs['Backfacing'], side.inputs[0])
        tree.links.new(front, side.inputs[1])
        tree.links.new(black.outputs[0], side.inputs[2])
        front = side.outputs[0]
    output = next(n for n in tree.nodes if n.type == 'OUTPUT_MATERIAL')
    tree.links.new(front, output.inputs['Surface'])
    tree.nodes.remove(principled)


def set_light(job):
    world = bpy.data.worlds.new('sky')
    bpy.context.scene.world = world
    world.use_nodes = True
    background = world.node_tree.nodes['Background']
    background.inputs['Color'].default_value = (*job['sky_radiance'], 1.0)
    background.inputs['Strength'].default_value = 1.0
    if not job['sky_image']:
        return
    picture = world.node_tree.nodes.new('ShaderNodeTexEnvironment')
    picture.image = bpy.data.images.load(job['sky_image'])
    picture.image.colorspace_settings.name = 'Linear'
    picture.projection = 'EQUIRECTANGULAR'
    picture.interpolation = 'Linear' if job['is_bilinear'] else 'Closest'
    world.node_tree.links.new(picture.outputs['Color'], background.inputs['Color'])
    # Texel for texel is the exact density of a nearest lookup. A bilinear one reaches into neighbours: there a map of the image's
    # own size has far too small densities beside a bright texel, and Cycles' own choice of 4096 is better.
    world.cycles.sampling_method = 'AUTOMATIC' if job['is_bilinear'] else 'MANUAL'
    world.cycles.sample_map_resolution = job['sky_width']


def set_camera(job):
    scene = bpy.context.scene
    camera = bpy.data.cameras.new('view')
    thing = bpy.data.objects.new('view', camera)
    scene.collection.objects.link(thing)
    scene.camera = thing
    forward, up, eye = (to_blender(job['camera'][k]) for k in ('forward', 'up', 'eye'))
    right = forward.cross(up)
    thing.matrix_world = Matrix.Translation(eye) @ Matrix((right, up, -forward)).transposed().to_4x4()
    camera.sensor_fit = 'VERTICAL'
    camera.lens_unit = 'FOV'
    camera.angle = job['camera']['vertical_fov_rad']
    camera.clip_start = 1e-4
    camera.clip_end = 1e6


def set_limits(job):
    scene = bpy.context.scene
    render = scene.render
    render.engine = 'CYCLES'
    render.resolution_x, render.resolution_y, render.resolution_percentage = job['width'], job['height'], 100
    render.use_compositing = render.use_sequencer = render.use_persistent_data = False
    render.film_transparent = render.use_motion_blur = render.use_file_extension = False
    render.dither_intensity = 0.0
    render.image_settings.file_format = 'OPEN_EXR'
    render.image_settings.color_mode = 'RGB'
    render.image_settings.color_depth = '32'
    render.image_settings.exr_codec = 'ZIP'
    render.threads_mode = 'AUTO'  # -t of the command line counts
    scene.view_settings.view_transform = 'Standard'
    cycles = scene.cycles
    cycles.device = 'CPU'
    cycles.pixel_filter_type = 'BOX'
    cycles.film_exposure = 1.0
    cycles.use_denoising = cycles.use_fast_gi = cycles.use_adaptive_sampling = cycles.use_auto_tile = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0  # factory 10 indirect: biased
    cycles.light_sampling_threshold = 0.0
    cycles.blur_glossy = 0.0
    cycles.max_bounces = cycles.diffuse_bounces = job['bounces']
    cycles.glossy_bounces = cycles.transmission_bounces = cycles.volume_bounces = cycles.transparent_max_bounces = 0
    cycles.min_light_bounces = 0  # Russian roulette from the start
    cycles.time_limit = 0.0
    cycles.use_animated_seed = False


def render(run):
    scene = bpy.context.scene
    scene.cycles.samples = run['spp']
    scene.cycles.seed = run['seed']
    scene.render.filepath = run['out']
    start = time.perf_counter()
    bpy.ops.render.render(write_still=True)
    say(seconds=time.perf_counter() - start)


def main():
    with open(sys.argv[sys.argv.index('--') + 1], encoding='utf-8') as file:
        job = json.load(file)
    load_mesh(job)
    set_light(job)
    set_camera(job)
    set_limits(job)
    say(ready=bpy.app.version_string)
    for line in sys.stdin:
        render(json.loads(line))


main()

#!/usr/bin/env python3
"""film_truth_h5.py FILM.truth.json ... : the same truth in the layout of the independent lab films
(FILM.truth.h5 beside it, and what their score.py reads of the JSON), so that one scorer serves both.
Needs python3-numpy and python3-h5py."""
import json, sys
import numpy as np, h5py

for path in sys.argv[1:]:
    truth = json.load(open(path))
    rows = np.genfromtxt(path.replace('.truth.json', '.truth.csv'), delimiter=',', names=True)
    ball = rows['id'].astype(int)
    of_ball = {k: np.array(v)[ball] for k, v in truth['balls'].items()}
    camera, source = truth['camera'], truth['recorded_frame_of_file_frame']
    eye = np.array(camera['position_m'])
    reach = -rows['z_m'] / (eye[2] - rows['z_m'])  # from the ball towards the camera, as far as the glass
    with h5py.File(path.replace('.json', '.h5'), 'w') as h:
        b = h.create_group('balls')
        for name, values in {
                'frame': rows['frame'].astype('i4'), 'id': ball.astype('i4'), 'u_px': rows['u_px'], 'v_px': rows['v_px'],
                'r_px': rows['r_px'], 'vis': rows['visible'], 'x_mm': rows['x_m'] * 1e3, 'y_mm': rows['y_m'] * 1e3,
                'z_mm': rows['z_m'] * 1e3, 'r_mm': of_ball['radius_m'] * 1e3, 'theta_rad': rows['theta_rad'],
                'vx': rows['vx'], 'vy': rows['vy'], 'glare': rows['glare'],
                'xplane_mm': (rows['x_m'] + reach * (eye[0] - rows['x_m'])) * 1e3,
                'yplane_mm': (rows['y_m'] + reach * (eye[1] - rows['y_m'])) * 1e3,
                'tracer': of_ball['tracer'].astype('i1'), 'marked': of_ball['marked'].astype('i1')}.items():
            b[name] = values
        f = h.create_group('frames')
        f['src'] = np.array(source)
        f['t'] = np.array(source) / truth['fps_recorded']
        undefined = lambda values: np.array([np.nan if v is None else v for v in values])
        for name in ('toe_deg', 'shoulder_deg'):
            f[name] = undefined(truth['charge'][name + '_of_recorded_frame'])[source]
    scale = camera['mill_radius_px'] / truth['mill']['radius_m'] / 1e3
    charge = truth['charge']
    mean = {}
    for which in ('toe', 'shoulder'):
        half, bulk, outer = (charge[f'{which}{k}_deg'] for k in ('', '_bulk', '_outer'))
        mean.update({f'{which}_deg': half, f'{which}75_deg': bulk, f'{which}25_deg': outer, f'{which}10_deg': outer,
                     f'{which}_front_deg': half, f'{which}_band_deg': [half, half]})
    truth.update(name=path.split('/')[-1].split('.')[0], mean=mean)
    camera.update(px_per_mm_at_centre=scale, C=camera['position_m'])
    json.dump(truth, open(path, 'w'), indent=1)

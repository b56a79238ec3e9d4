#!/usr/bin/env python3
"""Teaches the network that finds balls (ball_net.h). Needs python3-torch, python3-opencv, python3-numpy.

  make_films pictures --count 3000 --seed 1 --out DIR
  train_ball_net.py DIR... --minutes 180 --state ball_net.pt --weights analysis/nets/ball_net.weights
"""
import cv2
import numpy as np
import torch
import torch.nn as nn
import torch.nn.functional as F

import pictures as pics

RADIUS = 8.0  # kNetRadius [px]
SIDE = 192    # of the patches [px]


class Block(nn.Module):
    def __init__(self, width, dilation):
        super().__init__()
        self.a = nn.Conv2d(width, width, 3, 1, dilation, dilation=dilation)
        self.b = nn.Conv2d(width, width, 3, 1, 1)

    def forward(self, x):
        return F.relu(x + self.b(F.relu(self.a(x))))


class BallNet(nn.Module):
    """Maps on a grid of 2 px: heat, shift along u and v [cells], log(radius / 8 px), visible, log deviation, cover."""

    def __init__(self):
        super().__init__()
        self.a = nn.Conv2d(3, 16, 5, 2, 2)
        self.b = nn.Conv2d(16, 32, 3, 2, 1)
        self.r = nn.Sequential(*[Block(32, d) for d in (1, 2, 1, 2)])
        self.u = nn.Conv2d(32, 64, 1)
        self.f = nn.Conv2d(32, 16, 3, 1, 1)
        self.o = nn.Conv2d(16, 7, 1)
        nn.init.constant_(self.o.bias[0:1], -3.0)
        nn.init.normal_(self.o.weight, 0, 0.01)

    def forward(self, x):
        fine = F.relu(self.a(x))
        x = F.pixel_shuffle(F.relu(self.u(self.r(F.relu(self.b(fine))))), 2)
        return self.o(F.relu(self.f(torch.cat([fine, x], 1))))

    def convolutions(self):
        return [self.a, self.b] + [c for block in self.r for c in (block.a, block.b)] + [self.u, self.f, self.o]


def prepare(picture, balls, cover, about):
    """The drum and somewhat round it, scaled so that the smallest balls have the net's radius."""
    if len(balls) < 5 or (balls[:, 3] > pics.LEAST_VISIBLE).sum() < 5:
        return None
    smallest = balls[balls[:, 4] == balls[:, 4].min(), 2]
    scale = RADIUS / np.median(smallest)
    (u, v), reach = about['camera']['mill_centre_px'], 1.2 * about['camera']['mill_radius_px']
    u0, v0 = int(max(0, u - reach)), int(max(0, v - reach))
    u1, v1 = int(min(picture.shape[1], u + reach)), int(min(picture.shape[0], v + reach))
    if min(u1 - u0, v1 - v0) < 20 or scale > 3:
        return None
    picture, cover = picture[v0:v1, u0:u1], cover[v0:v1, u0:u1]
    size = max(64, round((u1 - u0) * scale)), max(64, round((v1 - v0) * scale))
    su, sv = size[0] / (u1 - u0), size[1] / (v1 - v0)
    picture = cv2.resize(picture, size, interpolation=cv2.INTER_AREA if scale < 1 else cv2.INTER_LINEAR)
    cover = cv2.resize(cover, size, interpolation=cv2.INTER_AREA)
    balls = balls.copy()
    balls[:, 0] = (balls[:, 0] - u0 + 0.5) * su - 0.5
    balls[:, 1] = (balls[:, 1] - v0 + 0.5) * sv - 0.5
    balls[:, 2] *= scale
    return picture, balls, cover


def targets(balls):
    n = SIDE // 2
    heat, weight = np.zeros((n, n), np.float32), np.ones((n, n), np.float32)
    near, told, least = np.zeros((n, n), np.float32), np.zeros((4, n, n), np.float32), np.full((n, n), 1e9, np.float32)
    for u, v, r, visible, _ in balls:
        cu, cv, spread = (u - 0.5) / 2, (v - 0.5) / 2, 0.125 * r + 0.25
        i0, i1 = int(max(0, np.floor(cv - 3 * spread))), int(min(n - 1, np.ceil(cv + 3 * spread)))
        j0, j1 = int(max(0, np.floor(cu - 3 * spread))), int(min(n - 1, np.ceil(cu + 3 * spread)))
        if i1 < i0 or j1 < j0 or visible <= 0.1:
            continue
        j, i = np.meshgrid(np.arange(j0, j1 + 1), np.arange(i0, i1 + 1))
        here, d2 = (slice(i0, i1 + 1), slice(j0, j1 + 1)), (j - cu) ** 2 + (i - cv) ** 2
        bell = np.exp(-d2 / (2 * spread * spread))
        if visible < pics.LEAST_VISIBLE:  # neither to be found nor to be denied
            weight[here][bell > 0.2] = 0
            continue
        heat[here] = np.maximum(heat[here], bell)
        own = (d2 < 1.6 ** 2) & (d2 < least[here])
        least[here][own], near[here][own] = d2[own], 1
        for k, value in enumerate((cu - j, cv - i, np.log(r / RADIUS) + 0 * d2, min(visible, 1) + 0 * d2)):
            told[k][here][own] = value[own]
    weight[heat > 0.05] = 1
    return heat, weight, near, told


def make_batch(pictures, rng, count=8):
    x, n = np.empty((count, 3, SIDE, SIDE), np.float32), SIDE // 2
    heat, weight, near, cover = (np.empty((count, n, n), np.float32) for _ in range(4))
    told = np.empty((count, 4, n, n), np.float32)
    for k in range(count):
        picture, balls, covered = pictures.any(rng)
        seen = balls[balls[:, 3] > pics.LEAST_VISIBLE]
        at = seen[rng.integers(len(seen)), :2] + rng.uniform(-70, 70, 2)
        if rng.random() < 0.15:
            at = rng.uniform(0, 1, 2) * picture.shape[1::-1]
        scale = np.exp(rng.uniform(-0.12, 0.12))
        m = pics.turned(rng, scale, at, SIDE)
        patch = cv2.warpAffine(picture, m, (SIDE, SIDE), flags=cv2.INTER_LINEAR, borderMode=cv2.BORDER_REFLECT_101)
        inside = cv2.warpAffine(np.ones(picture.shape[:2], np.float32), m, (SIDE, SIDE), flags=cv2.INTER_NEAREST)[::2, ::2]
        moved = balls.copy()
        moved[:, :2], moved[:, 2] = balls[:, :2] @ m[:, :2].T + m[:, 2], balls[:, 2] * scale
        patch = pics.vary(patch, rng)
        x[k] = ((patch - patch.mean()) / (patch.std() + 8)).transpose(2, 0, 1)
        heat[k], weight[k], near[k], told[k] = targets(moved)
        weight[k] *= inside
        near[k] *= inside
        covered = cv2.warpAffine(covered, m, (SIDE, SIDE), flags=cv2.INTER_LINEAR, borderMode=cv2.BORDER_REFLECT_101)
        cover[k] = cv2.resize(covered.astype(np.float32) / 255, (n, n), interpolation=cv2.INTER_AREA)
    return x, heat, weight, near, told, cover


def losses(net, x, heat, weight, near, told, cover):
    y = net(x.to(memory_format=torch.channels_last))
    p = torch.sigmoid(y[:, 0]).clamp(1e-4, 1 - 1e-4)
    peak = (heat > 0.8).float()
    found = -(peak * (1 - p) ** 2 * torch.log(p) + (1 - peak) * (1 - heat) ** 4 * p ** 2 * torch.log(1 - p)) * weight
    found = found.sum() / peak.sum().clamp(min=1)
    count = near.sum().clamp(min=1)
    deviation = y[:, 5].clamp(-5, 3)
    d2 = (y[:, 1] - told[:, 0]) ** 2 + (y[:, 2] - told[:, 1]) ** 2
    place = ((2 * torch.log1p(d2 * torch.exp(-2 * deviation) / 2) + 2 * deviation) * near).sum() / count
    radius = (F.smooth_l1_loss(y[:, 3], told[:, 2], reduction='none', beta=0.02) * near).sum() / count
    visible = (F.mse_loss(torch.sigmoid(y[:, 4]), told[:, 3], reduction='none') * near).sum() / count
    charge = (F.binary_cross_entropy_with_logits(y[:, 6], cover, reduction='none') * (weight > 0)).mean()
    numbers = [t.item() for t in (found, place, radius, visible, charge)]
    return found + 0.4 * place + 3 * radius + 0.5 * visible + 2 * charge, numbers


if __name__ == '__main__':
    pics.main(__doc__, lambda: BallNet().to(memory_format=torch.channels_last), make_batch, prepare, losses, minutes=180)

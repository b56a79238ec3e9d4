#!/usr/bin/env python3
"""Teaches the network that puts a ball's centre right (ball_refiner.h). Needs what train_ball_net.py needs.

  train_ball_refiner.py DIR... --minutes 120 --state ball_refiner.pt --weights analysis/nets/ball_refiner.weights
"""
import cv2
import numpy as np
import torch
import torch.nn as nn
import torch.nn.functional as F

import pictures as pics

RADIUS, SIDE = 8.0, 24  # of the ball in the patch, of the patch [px]


class BallRefiner(nn.Module):
    """Shift of the centre along u and v [radii], log of its deviation, log(radius / supposed), visible."""

    def __init__(self):
        super().__init__()
        self.a = nn.Conv2d(3, 16, 3, 1, 1)
        self.b = nn.Conv2d(16, 32, 3, 2, 1)
        self.c = nn.Conv2d(32, 32, 3, 1, 1)
        self.d = nn.Conv2d(32, 64, 3, 2, 1)
        self.e = nn.Conv2d(64, 64, 3, 1, 1)
        self.f = nn.Conv2d(64, 64, SIDE // 4)
        self.g = nn.Conv2d(64, 5, 1)
        nn.init.normal_(self.g.weight, 0, 0.01)
        nn.init.zeros_(self.g.bias)

    def forward(self, x):
        x = F.relu(self.b(F.relu(self.a(x))))
        x = F.relu(self.d(F.relu(x + self.c(x))))
        return self.g(F.relu(self.f(F.relu(x + self.e(x)))))[:, :, 0, 0]

    def convolutions(self):
        return [self.a, self.b, self.c, self.d, self.e, self.f, self.g]


def prepare(picture, balls, cover, about):
    height, width = picture.shape[:2]
    here = (balls[:, 3] > pics.LEAST_VISIBLE) & (balls[:, 2] > 3.2) & (balls[:, 0] > 0) & (balls[:, 1] > 0)
    here &= (balls[:, 0] < width) & (balls[:, 1] < height)
    return (picture, balls[here]) if here.sum() > 3 else None


def patch_of(picture, m, scale, u, v, r):
    """The patch, with what is too fine for it averaged out first."""
    if scale < 0.8:
        reach = int(np.ceil(2.4 * r)) + 3
        u0, v0 = max(0, int(u) - reach), max(0, int(v) - reach)
        part = cv2.GaussianBlur(picture[v0:int(v) + reach + 1, u0:int(u) + reach + 1], (0, 0), 0.45 * np.sqrt(scale ** -2 - 1))
        m = np.concatenate([m[:, :2], (m[:, 2] + m[:, :2] @ [u0, v0])[:, None]], 1)
        return cv2.warpAffine(part, m, (SIDE, SIDE), flags=cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    return cv2.warpAffine(picture, m, (SIDE, SIDE), flags=cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)


def dress(patches, told, rng):
    """Other light and paint on whole balls, so that the outline tells where they are, and neither shading nor marks."""
    def some(share):  # which balls, as factors
        return (rng.random(n) < share).astype(np.float32)[:, None, None]

    def each(low, high):
        return rng.uniform(low, high, n).astype(np.float32)[:, None, None]

    def soft(edge):
        return 1 / (1 + np.exp(-edge.clip(-30, 30)))

    n, grid = len(patches), np.arange(SIDE, dtype=np.float32) - 0.5 * (SIDE - 1)
    radius = RADIUS * np.exp(told[:, 2])[:, None, None]
    x = (grid[None, None, :] - RADIUS * told[:, 0, None, None]) / radius
    y = (grid[None, :, None] - RADIUS * told[:, 1, None, None]) / radius
    far = np.sqrt(x * x + y * y)
    inside = (told[:, 3] > 0.97)[:, None, None] * soft((1 - far) * radius / each(0.15, 0.5))
    z = np.sqrt(np.maximum(0, 1 - far * far))
    turn, height = each(0, 2 * np.pi), each(0.1, 1)
    flat = np.sqrt(1 - height * height)
    light = x * flat * np.cos(turn) + y * flat * np.sin(turn) + z * height
    gain = 1 + inside * some(0.5) * each(-0.4, 0.7) * (light - 0.6)
    gain *= 1 - (1 - inside) * some(0.3) * each(0, 0.6) * np.exp(-np.maximum(0, far - 1) / each(0.05, 0.4))  # shadow
    patches *= np.maximum(0.05, gain)[..., None]
    turn = each(0, 2 * np.pi)
    along, across = x * np.cos(turn) + y * np.sin(turn), y * np.cos(turn) - x * np.sin(turn)
    across -= np.where(rng.random(n) < 0.6, 0, rng.normal(0, 0.3, n)).astype(np.float32)[:, None, None]
    across -= each(-0.2, 0.2) * along * along  # as on a sphere
    stripe = soft((each(0.05, 0.25) - np.abs(across)) * radius / each(0.15, 0.5))
    stripe *= soft((each(0.3, 1.2) - np.abs(along - each(-0.2, 0.2))) * radius / 0.3)
    paint = (rng.uniform(0, 255, (n, 1)) + rng.normal(0, 40, (n, 3)) * (rng.random((n, 1)) < 0.5)).astype(np.float32)
    alpha = (inside * some(0.35) * each(0.2, 1) * stripe)[..., None]
    patches += alpha * (paint[:, None, None, :] * (0.5 + 0.5 * z)[..., None] - patches)
    spot = (x - each(-0.7, 0.7)) ** 2 + (y - each(-0.7, 0.7)) ** 2
    patches += (inside * some(0.3) * each(0, 150) * np.exp(-spot / (2 * each(0.05, 0.3) ** 2)))[..., None]
    return patches.clip(0, 255)


def make_batch(pictures, rng, count=256):
    patches, told, k = np.empty((count, SIDE, SIDE, 3), np.float32), np.empty((count, 4), np.float32), 0
    while k < count:
        picture, balls = pictures.any(rng)
        for _ in range(min(16, count - k)):
            u, v, r, visible, _class = balls[rng.integers(len(balls))]
            off, growth = rng.normal(0, 0.1, 2).clip(-0.4, 0.4) * r, rng.normal(0, 0.03)
            scale = RADIUS / (r * np.exp(growth))
            m = pics.turned(rng, scale, (u + off[0], v + off[1]), SIDE)
            patches[k] = patch_of(picture, m, scale, u, v, r)
            shift = m[:, :2] @ -off / RADIUS
            told[k] = shift[0], shift[1], -growth, min(1, visible)
            k += 1
    patches = dress(patches, told, rng)
    x = np.empty((count, 3, SIDE, SIDE), np.float32)
    for k in range(count):
        patch = pics.vary(patches[k], rng)
        x[k] = ((patch - patch.mean()) / (patch.std() + 6)).transpose(2, 0, 1)
    return x, told


def losses(net, x, told):
    y = net(x)
    deviation, d2 = y[:, 2].clamp(-6, 1), ((y[:, :2] - told[:, :2]) ** 2).sum(1)
    place = (2 * torch.log1p(d2 * torch.exp(-2 * deviation) / 2) + 2 * deviation).mean()
    radius = F.smooth_l1_loss(y[:, 3], told[:, 2], beta=0.02)
    visible = F.mse_loss(torch.sigmoid(y[:, 4]), told[:, 3])
    whole = d2.detach()[told[:, 3] > 0.9]
    numbers = [place.item(), RADIUS * d2.detach().median().item() ** 0.5, RADIUS * whole.median().item() ** 0.5, visible.item()]
    return place + 3 * radius + 0.5 * visible, numbers


if __name__ == '__main__':
    pics.main(__doc__, BallRefiner, make_batch, prepare, losses, minutes=120, ahead=12)
